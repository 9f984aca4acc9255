// What a device takes of a solver: bytes of a buffer, workgroups of a dispatch.
#pragma once

#include "model/range_checks.hpp"

#include <cstdint>
#include <limits>
#include <string>

namespace voile
{

struct DeviceLimits
{
    uint32_t workgroup_size = 128;                                    // of the solver, not the device's largest
    uint32_t max_workgroups = std::numeric_limits<uint32_t>::max();   // of each dispatch
    uint64_t max_buffer_bytes = std::numeric_limits<uint64_t>::max(); // of each buffer: what the device binds
};

// Errors: `contents` need a buffer of more bytes than the device binds.
Result<void> check_room(const DeviceLimits& limits, const std::string& what, const std::string& name,
                        const std::string& contents, uint64_t bytes);
// Errors: a dispatch of more workgroups than the device takes. `contents` need them.
Result<void> check_dispatch(const DeviceLimits& limits, const std::string& what, const std::string& name,
                            const std::string& contents, uint64_t workgroups);

} // namespace voile
