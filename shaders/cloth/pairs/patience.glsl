// When new lists are made. They are made for all cloth, and some vertices of a large cloth nearly always want them: where
// lists are full, so that they leave little reach. So a few vertices wait, held where their sweeps end, until more of them
// want lists or some passes are over.
//
// The including kernel declares pair_searches[].
#ifndef VOILE_PATIENCE_GLSL
#define VOILE_PATIENCE_GLSL

// So many passes after lists were made, one vertex suffices.
const uint k_patience = 4;

// So many vertices suffice at once.
uint most_urgency() { return pair_searches[VOILE_PAIR_MOST_URGENCY].entries; }

// Of a pass that uses lists once more.
void age_lists() { pair_searches[VOILE_PAIR_URGENCY].entries += most_urgency() / k_patience + 1; }

bool are_lists_wanted() { return pair_searches[VOILE_PAIR_OF_PLACES].wanted != 0; }

void want_lists()
{
    for (uint k = 0; k < VOILE_PAIR_SEARCHES; ++k)
        pair_searches[k].wanted = 1;
}

// Of a vertex that can wait. Whether it does depends on a sum, and so on no timing.
void wait_for_lists()
{
    if (atomicAdd(pair_searches[VOILE_PAIR_URGENCY].entries, 1) + 1 >= most_urgency())
        want_lists();
}

#endif
