// What the device can do at best: how fast it copies, and what a dispatch costs that does nothing.
#pragma once

#include "timed_queue.hpp"

namespace bench
{

struct DeviceProbe
{
    double copy_bandwidth = 0; // bytes/s, read plus written, by a large copy
    double empty_dispatch = 0; // microseconds, with its barrier
};

DeviceProbe probe_device(TimedQueue& queue);

} // namespace bench
