// Push constants of an output: where a cloth's vertices are, and where they go in the host's buffer.
#ifndef VOILE_OUTPUT_LAYOUT_H
#define VOILE_OUTPUT_LAYOUT_H

#include "../../shared_types.h"

#define VOILE_NO_ATTRIBUTE 0xffffffffu

VOILE_SHARED_BEGIN(voile)

// Words are counted from the start of the bound range, or of a vertex; VOILE_NO_ATTRIBUTE: the host does not want it.
struct OutputPush
{
    uint first_vertex; // in the solver's buffers
    uint vertices;
    uint first_word; // of the first vertex in the host's buffer
    uint stride;     // words from one vertex to the next
    uint position;   // words
    uint normal;     // words
    uint velocity;   // words
    uint previous;   // words
};

VOILE_SHARED_END

#endif
