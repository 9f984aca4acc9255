// The device's limits: the bandwidth of a copy and the cost of an empty dispatch.
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
