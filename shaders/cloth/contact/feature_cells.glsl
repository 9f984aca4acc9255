// The items in the cells around a vertex, and their contacts and planes (test_features.comp).
//
// The including kernel declares cells[], feature_responses[] and push (FeaturePush), and includes feature_lanes.glsl and
// what that needs before.
#ifndef VOILE_FEATURE_CELLS_GLSL
#define VOILE_FEATURE_CELLS_GLSL

// The cells that the vertex is in: of a grid four, of a mesh one. In the cell to the left, for example, it is the vertex
// to the right.
bool has_cell(uint i)
{
    return self.vertex.columns == 0 ? i == 0
                                    : in_grid(self.vertex.column_row - k_cell[i], self.vertex.columns, self.vertex.rows);
}

// Takes the lowest of 128 bits. False: none is left. Without an index into the vector, which drivers keep in memory.
bool take_bit(inout uvec4 bits, out uint position)
{
    const bool low = (bits.x | bits.y) != 0;
    uvec2 half_of_bits = low ? bits.xy : bits.zw;
    const bool lower = half_of_bits.x != 0;
    const uint word = lower ? half_of_bits.x : half_of_bits.y;
    position = (low ? 0 : 64) + (lower ? 0 : 32) + findLSB(word);
    half_of_bits = uvec2(lower ? word & (word - 1) : 0, lower ? half_of_bits.y : word & (word - 1));
    bits = low ? uvec4(half_of_bits, bits.zw) : uvec4(0, 0, half_of_bits);
    return word != 0;
}

// Merges the contacts of a cell, in which the vertex is the i-th one. `touched`: bits of the items from `first` on.
void merge_items(uint first, uvec4 touched, uint i)
{
    uint item;
    while (take_bit(touched, item))
    {
        const FeatureResponse touch = feature_responses[first + item];
        if (touch.portions[i] > 0)
            respond(Impulse(touch.direction, touch.correction, touch.slowing, touch.approach), touch.portions[i],
                    touch.collider, FeatureMotion(touch.carried, touch.turned));
    }
}

// The same for planes.
void add_planes(uint first, uvec4 touched, uint i)
{
    uint position;
    while (take_bit(touched, position))
    {
        const uint item = first + position;
        const vec4 plane = feature_responses[item].plane;
        if ((feature_responses[item].vertices & 1u << i) == 0 || plane.xyz == vec3(0))
            continue;
        select_collider(feature_responses[item].collider);
        add_plane(GuardPlane(plane, FeatureMotion(feature_responses[item].carried, feature_responses[item].turned)));
    }
}

// The items around the vertex.
struct Items
{
    uint firsts[4]; // of each cell
    uvec4 touched[4];
    bool valid; // they suffice
    bool any;
    bool guarded;
};

Items load_items()
{
    Items items;
    items.valid = true;
    items.guarded = false;
    uvec4 any = uvec4(0);
    for (uint i = 0; i < 4; ++i) // without branches around the loads, which are issued together
    {
        const bool has = has_cell(i);
        const uint cell = has ? neighbor(self.vertex.index, -k_cell[i], self.vertex.columns) : self.vertex.index;
        items.firsts[i] = cells[cell].first;
        const uvec4 touched = cells[cell].touched[push.pass & 1];
        items.touched[i] = has ? touched : uvec4(0);
        any |= items.touched[i];
        const uint invalid = cells[cell].invalid;
        items.valid = items.valid && (!has || (invalid != counted_substep(push.substep) && invalid != VOILE_EVERY_SUBSTEP));
        items.guarded = items.guarded || (has && cells[cell].guarded == counted_substep(push.substep));
    }
    items.any = any != uvec4(0);
    return items;
}

#endif
