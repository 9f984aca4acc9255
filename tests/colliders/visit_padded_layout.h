// Bindings and push constants of visit_padded.comp.
#ifndef VOILE_VISIT_PADDED_LAYOUT_H
#define VOILE_VISIT_PADDED_LAYOUT_H

#include "../../shaders/shared_types.h"

#define VISIT_BOXES 0
#define VISIT_QUERIES 1
#define VISIT_ANSWERS 2

VOILE_SHARED_BEGIN(tests)

struct VisitPush
{
    uint first_box;
    uint first_leaf;
    uint triangles;
    uint queries;
    uint room; // words per answer: the count, then as many slots as fit
};

VOILE_SHARED_END

#endif
