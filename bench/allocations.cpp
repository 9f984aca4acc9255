// Replaces operator new and delete and counts the calls. The array and nothrow forms call these.
#include "allocations.hpp"

#include <cstdlib>
#include <new>

namespace
{

thread_local uint64_t t_allocations = 0;

void* counted(void* memory)
{
    ++t_allocations;
    if (memory == nullptr)
        throw std::bad_alloc();
    return memory;
}

} // namespace

namespace bench
{

uint64_t allocations()
{
    return t_allocations;
}

} // namespace bench

void* operator new(size_t bytes)
{
    return counted(std::malloc(bytes > 0 ? bytes : 1));
}

void* operator new(size_t bytes, std::align_val_t alignment)
{
    const auto unit = static_cast<size_t>(alignment);
    return counted(std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit));
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, size_t) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, size_t, std::align_val_t) noexcept
{
    std::free(memory);
}
