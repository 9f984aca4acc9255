// A count of heap allocations: operator new is replaced in this program.
#pragma once

#include <cstdint>

namespace bench
{

// How often the calling thread has called operator new so far. The driver's own calls of malloc are not counted.
uint64_t allocations();

} // namespace bench
