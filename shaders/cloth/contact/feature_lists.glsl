// Lists of the features near triangles of a cloth, made by find_near_features.comp and read by feature_contact.comp.
//
// A list contains all features within the thickness and a margin of its triangles, where these were when the list was
// made. It is valid while no vertex of them has moved farther than the margin, relative to the collider. The head has
// the margin and the length. An entry is a feature, and a lower bound of its distance beyond the thickness: a level, a
// fraction of the margin. Entries farther than the vertices have moved are skipped.
//
// The including kernel declares feature_lists[] and push.vertices.
#ifndef VOILE_FEATURE_LISTS_GLSL
#define VOILE_FEATURE_LISTS_GLSL

const uint k_feature_levels = 32;
const uint k_feature_bits = 27; // of an entry
const uint k_count_mask = 31;   // of a head

struct FeatureList
{
    float margin; // m
    uint count;   // VOILE_FEATURE_ENTRIES + 1: more than fit
};

// Word-major order: neighboring threads read the same word at the same time.
uint head_word(uint list) { return list; }
uint entry_word(uint list, uint i) { return (i + 1) * VOILE_FEATURE_LISTS * push.vertices + list; }

uint packed(FeatureList list) { return (floatBitsToUint(list.margin) & ~k_count_mask) | list.count; }
FeatureList unpacked(uint head) { return FeatureList(uintBitsToFloat(head & ~k_count_mask), head & k_count_mask); }

// The feature of an entry.
uint feature_of(uint entry) { return entry & ((1u << k_feature_bits) - 1); }
// m: a lower bound of its distance beyond the thickness.
float excess_of(uint entry, float margin) { return float(entry >> k_feature_bits) / k_feature_levels * margin; }

#endif
