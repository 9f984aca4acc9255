// Room for the items of vertices: how many each gets, and where.
//
// Each thread has counted its items within every margin. The workgroup adds them up per vertex, chooses the widest margin
// with few enough, and claims room for all of its vertices at once.
//
// The including kernel declares cells[], dispatch_size[], traversals[] and push (NearFeaturesPush), and defines
// FeatureSearch, k_margins and k_fractions before, and scratch[] with k_margins elements per thread at least. It sets
// items_of_group, fewer_items, fewest_items and first_of_group to 0.
#ifndef VOILE_FEATURE_ROOM_GLSL
#define VOILE_FEATURE_ROOM_GLSL

#include "contact/traversal_size.glsl"

// Of the workgroup.
shared uint items_of_group;
shared uint fewer_items;                            // that the workgroup would have with fewer of each vertex
shared uint fewest_items;                           // with the fewest
shared uint first_of_group;                         // of the batch's items
shared uint searching_vertices;                     // 0: all have too many items
shared uint lane_counts[gl_WorkGroupSize.x];        // with the margin that was chosen; before, margins of vertices
shared uint cell_firsts[gl_WorkGroupSize.x];        // of each vertex, in the workgroup's items

// The most items of a vertex.
uint most_items()
{
    if (push.retries == 0)
        return VOILE_MOST_FEATURE_ITEMS;
    if (dispatch_size[push.dispatch_word + VOILE_DISPATCH_FEWER] <= push.items)
        return VOILE_FEWER_FEATURE_ITEMS;
    if (dispatch_size[push.dispatch_word + VOILE_DISPATCH_FEWEST] <= push.items)
        return VOILE_FEWEST_FEATURE_ITEMS;
    return push.items / (gl_NumWorkGroups.x / push.lanes * gl_WorkGroupSize.x);
}

// The index of the margin with few enough items; k_margins: none.
uint choose_margin(uint in_group, uint most)
{
    for (uint i = 0; i < k_margins; ++i)
        if (scratch[k_margins * in_group + i] <= most)
            return i;
    return k_margins;
}

// Narrows the margin of a vertex if there are too many features within it already. If that was the last one, it no longer
// searches. Returns whether any vertex of the workgroup does. All of its threads call it.
bool narrow(inout FeatureSearch search, inout bool searches, uint lane)
{
    const uint thread = gl_LocalInvocationID.x;
    lane_counts[thread] = search.narrowed == 0   ? search.counts.x
                          : search.narrowed == 1 ? search.counts.y
                          : search.narrowed == 2 ? search.counts.z
                                                 : search.counts.w;
    if (thread == 0)
        searching_vertices = 0;
    barrier();
    uint count = 0;
    for (uint i = 0; i < push.lanes; ++i)
        count += lane_counts[thread - lane + i];
    if (count > most_items())
        search.narrowed = min(search.narrowed + 1, k_margins);
    searches = searches && search.narrowed < k_margins;
    search.margin = search.widest * k_fractions[min(search.narrowed, k_margins - 1)];
    if (searches)
        atomicOr(searching_vertices, 1);
    barrier();
    return searching_vertices != 0;
}

// Claims room for the items of the workgroup.
void claim_items()
{
    if (items_of_group == 0)
        return;
    const uint word = push.retries == 0 ? VOILE_DISPATCH_CLAIMED : VOILE_DISPATCH_RETRY_CLAIMED;
    first_of_group = atomicAdd(dispatch_size[push.dispatch_word + word], items_of_group);
    const uint end = first_of_group + items_of_group;
    if (push.retries == 0)
    {
        atomicAdd(dispatch_size[push.dispatch_word + VOILE_DISPATCH_FEWER], fewer_items);
        atomicAdd(dispatch_size[push.dispatch_word + VOILE_DISPATCH_FEWEST], fewest_items);
    }
    if (end <= push.items)
        atomicMax(dispatch_size[push.dispatch_word], (end + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x);
    else
        atomicMax(dispatch_size[push.dispatch_word + VOILE_DISPATCH_RETRY], gl_NumWorkGroups.x);
}

// The number of items of a vertex with `most` of them.
uint count_with(uint in_group, uint most)
{
    const uint chosen = choose_margin(in_group, most);
    return chosen < k_margins ? scratch[k_margins * in_group + chosen] : 0;
}

// Vertices without items traverse in all passes until the next query.
void traverse_always()
{
    const uint patches = gl_NumWorkGroups.x / push.lanes;
    write_traversal(push.traversal_word, 0, patches);
    write_traversal(push.traversal_word, 1, patches);
    traversals[push.traversal_word + VOILE_TRAVERSAL_UNLISTED] = patches;
}

// `fits`: it has all features that are near as items.
void write_cell(PatchVertex self, uint first, uint count, bool fits)
{
    if (self.exists && !fits)
        traverse_always();
    if (self.exists)
        cells[self.index] = FeatureCell(first, count, fits ? VOILE_NO_SUBSTEP : VOILE_EVERY_SUBSTEP, VOILE_NO_SUBSTEP,
                                        uvec4[2](uvec4(0), uvec4(0)));
}

// Chooses the margin of a vertex and claims room for its items. False: it has none.
bool allocate(inout FeatureSearch search, bool countable, uint lane, uint in_group)
{
    const uint thread = gl_LocalInvocationID.x;
    barrier(); // all threads have read the features there
    for (uint i = 0; i < k_margins; ++i)
        scratch[k_margins * thread + i] = 0;
    barrier();
    for (uint i = 0; i < k_margins; ++i)
        atomicAdd(scratch[k_margins * in_group + i], search.counts[i]);
    barrier();
    const uint chosen = choose_margin(in_group, most_items());
    const bool fits = countable && chosen < k_margins;
    const uint of_margin = min(chosen, k_margins - 1);
    const uint count = fits ? search.counts[of_margin] : 0;
    const uint cell_count = fits ? scratch[k_margins * in_group + of_margin] : 0;
    search.margin = search.widest * k_fractions[of_margin];
    lane_counts[thread] = count;
    if (lane == 0)
    {
        cell_firsts[in_group] = atomicAdd(items_of_group, cell_count);
        if (countable && push.retries == 0)
        {
            atomicAdd(fewer_items, count_with(in_group, VOILE_FEWER_FEATURE_ITEMS));
            atomicAdd(fewest_items, count_with(in_group, VOILE_FEWEST_FEATURE_ITEMS));
        }
    }
    barrier();
    if (thread == 0)
        claim_items();
    barrier();
    // Without room the query is repeated.
    const bool room = first_of_group + items_of_group <= push.items;
    const uint first = push.first_item + first_of_group + cell_firsts[in_group];
    search.next = first;
    for (uint i = thread - lane; i < thread; ++i)
        search.next += lane_counts[i];
    search.end = search.next + (room ? count : 0);
    if (lane == 0)
        write_cell(search.self, first, cell_count, fits);
    return room && cell_count > 0;
}

#endif
