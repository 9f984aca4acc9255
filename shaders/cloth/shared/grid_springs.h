// The springs of a grid vertex. See VOILE_SPRING_CLASSES for the order.
#ifndef VOILE_GRID_SPRINGS_H
#define VOILE_GRID_SPRINGS_H

#include "../../shared_types.h"

// Per spring class the columns and rows from a vertex to the vertex at the other end. The class has a second spring, in
// the opposite direction.
#define VOILE_SPRING_OFFSETS                                                                                           \
    ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1), ivec2(2, 0), ivec2(0, 2), ivec2(2, 2), ivec2(2, -2)

#endif
