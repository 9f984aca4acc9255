// What recording costs the host, command by command, and a secondary command buffer that is recorded once.
#pragma once

#include "timed_queue.hpp"

#include <vector>

namespace bench
{

struct RecordCost
{
    const char* what = nullptr;
    double host = 0; // ns each, to record
    double gpu = 0;  // us each, to run; 0: not measured
};

constexpr const char* k_record_case = "record-cost"; // its name
std::vector<RecordCost> measure_record_cost(TimedQueue& queue);

} // namespace bench
