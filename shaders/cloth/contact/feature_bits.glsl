// Which of the loaded features may be near a vertex. The lanes of the vertex find it together, so that each tests its pieces
// against these alone.
//
// The including kernel declares push (NearFeaturesPush), and includes feature_gathering.glsl before.
#ifndef VOILE_FEATURE_BITS_GLSL
#define VOILE_FEATURE_BITS_GLSL

// For each vertex one bit per loaded feature: it may be near a piece. Of workgroups with more vertices all may.
const uint k_bit_words = (k_most_loaded + 31) / 32;
const uint k_most_with_bits = 32; // vertices
shared uint feature_bits[k_bit_words * k_most_with_bits];

bool has_bits() { return gl_WorkGroupSize.x / push.lanes <= k_most_with_bits; }

// The lanes of each vertex share the features of a chunk. All threads of the workgroup call it.
void find_bits(Chunk chunk, bool near, Box pieces, uint lane)
{
    if (!has_bits())
        return;
    const uint first = k_bit_words * (gl_LocalInvocationID.x / push.lanes);
    for (uint word = chunk.first / 32 + lane; 32 * word < chunk.end; word += push.lanes)
        feature_bits[first + word] &= (1u << (max(chunk.first, 32 * word) - 32 * word)) - 1;
    barrier();
    for (uint f = chunk.first + lane; near && f < chunk.end; f += push.lanes)
        if (overlap(pieces, swept_box(loaded_feature(f))))
            atomicOr(feature_bits[first + f / 32], 1u << f % 32);
    barrier();
}

// Of a word of the features: those of the chunk that may be near a piece of the vertex.
uint bits_of(Chunk chunk, uint word)
{
    const uint from = max(chunk.first, 32 * word) - 32 * word;
    const uint bits = (chunk.end - 32 * word >= 32 ? 0xffffffffu : (1u << (chunk.end - 32 * word)) - 1) & ~((1u << from) - 1);
    return has_bits() ? bits & feature_bits[k_bit_words * (gl_LocalInvocationID.x / push.lanes) + word] : bits;
}

// A walk over the features of a chunk that may be near a piece of the vertex, in their order.
struct ChunkWalk
{
    uint word; // the next one
    uint bits; // the rest of the word before it
};

ChunkWalk walk_chunk(Chunk chunk) { return ChunkWalk(chunk.first / 32, 0); }

// The next feature whose box overlaps that of the piece. One loop for all of them: what is visited stands in one loop of the
// caller's, whose rounds are as many as there are overlaps, also on CPU devices.
bool next_feature(inout ChunkWalk walk, Chunk chunk, Box piece, out uint f)
{
    f = 0;
    while (walk.bits != 0 || 32 * walk.word < chunk.end)
    {
        if (walk.bits == 0)
            walk.bits = bits_of(chunk, walk.word++);
        if (walk.bits == 0)
            continue;
        f = 32 * (walk.word - 1) + findLSB(walk.bits);
        walk.bits &= walk.bits - 1;
        if (overlap(piece, swept_box(loaded_feature(f))))
            return true;
    }
    return false;
}

#endif
