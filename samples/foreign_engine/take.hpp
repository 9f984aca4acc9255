// The value of a Result, or an exception with its reason. Samples other than foreign_engine, which shows it whole.
#pragma once

#include <voile/result.hpp>

#include <stdexcept>
#include <utility>

template <typename T>
T take(voile::Result<T> result)
{
    if (!result)
        throw std::runtime_error(result.error().message);
    return std::move(result).value();
}

inline void take(const voile::Result<void>& result)
{
    if (!result)
        throw std::runtime_error(result.error().message);
}
