#version 460
// For tests: a thread copies an entry of each buffer, of different layouts, to the answers, word by word.
layout(local_size_x_id = 0) in;

struct Inner
{
    vec2 first;
    uint second;
    float third;
};

struct Wide // 112 bytes, in texels of 16
{
    vec3 direction;
    float size;
    uvec2 links;
    ivec2 signs;
    mat3 turn; // columns 16 bytes apart
    Inner inner[2];
};

struct Narrow // 24 bytes, in texels of 8
{
    vec2 a;
    uint b;
    float c;
    vec2 d;
};

struct Split // 32 bytes; the stride of `b` has no texel that holds a vec3: read as a storage buffer
{
    vec3 a;
    float b[5];
};

layout(set = 0, binding = 0, std430) readonly buffer Wides { Wide wides[]; };
layout(set = 0, binding = 1, std430) readonly buffer Narrows { Narrow narrows[]; };
layout(set = 0, binding = 2, std430) readonly buffer Words { float words[]; };
layout(set = 0, binding = 3, std430) readonly buffer Turns { mat4 turns[]; };
layout(set = 0, binding = 4, std430) readonly buffer Splits { Split splits[]; };
layout(set = 0, binding = 5, std430) readonly buffer Counted { uvec4 count; uvec4 counted[]; };
layout(set = 0, binding = 6, std430) buffer Changed { uvec4 changed[]; };            // texels of what is not written
layout(set = 0, binding = 7, std430) readonly buffer Measured { uvec2 measured[]; }; // its length is asked for
layout(set = 0, binding = 8, std430) buffer Written { uvec4 written[]; };            // one component is read where it is written
layout(set = 0, binding = 9, std430) readonly buffer Padded { uvec3 padded[]; };     // no texel that divides its end holds it
layout(set = 0, binding = 10, std430) writeonly buffer Answers { uint answers[]; };

layout(push_constant, std430) uniform Push { uint words_per_thread; };

uint next_answer;

void put(uint word) { answers[next_answer++] = word; }
void put(float value) { put(floatBitsToUint(value)); }
void put(vec2 v) { put(v.x), put(v.y); }
void put(vec3 v) { put(v.xy), put(v.z); }
void put(vec4 v) { put(v.xyz), put(v.w); }

void put(Inner inner)
{
    put(inner.first);
    put(inner.second);
    put(inner.third);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    next_answer = i * words_per_thread;
    const Wide wide = wides[i];
    put(wide.direction);
    put(wide.size);
    put(wide.links.x), put(wide.links.y);
    put(uint(wide.signs.x)), put(uint(wide.signs.y));
    put(wide.turn[0]), put(wide.turn[1]), put(wide.turn[2]);
    put(wide.inner[0]), put(wide.inner[1]);
    put(wides[i].inner[i & 1].third); // by an index that is no constant: a member's element,
    put(wides[i].turn[i % 3]);        // a column,
    put(wides[i].direction[i % 3]);   // a component
    put(wides[i].links.y);
    put(narrows[i].a);
    put(narrows[i].b);
    put(narrows[i].c);
    put(narrows[i].d);
    put(words[i]);
    put(turns[i][3]);
    put(turns[i][1][i & 3]);
    put(splits[i].a);
    put(splits[i].b[i % 5]);
    put(counted[i].z);
    put(count.w);
    changed[i].w = i;
    put(changed[i ^ 1].y);
    put(measured[i].x);
    put(measured.length() > i ? measured[i].y : 0);
    written[i].x = i;
    put(written[i].x);
    put(written[i].y);
    put(padded[i].z);
}
