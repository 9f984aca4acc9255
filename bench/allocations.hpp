// Counts heap allocations. Replaces operator new in this program.
#pragma once

#include <cstdint>

namespace bench
{

// The calls of operator new by the calling thread so far. The driver's own calls of malloc are not counted.
uint64_t allocations();

} // namespace bench
