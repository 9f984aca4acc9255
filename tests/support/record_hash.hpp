// A hash of the bits of arrays, so that a test can say that what a model makes of a mesh is what it made before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tests
{

// FNV-1a over the bytes of values. Types with padding must be added member by member.
class RecordHash
{
public:
    template <typename T>
    void add(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        for (const std::byte byte : std::as_bytes(std::span(&value, 1)))
            hash_ = (hash_ ^ std::to_integer<uint64_t>(byte)) * 0x100000001b3u;
    }

    // The count first: lists that are cut elsewhere differ.
    template <typename Array>
    void add_all(const Array& values)
    {
        add(uint64_t{values.size()});
        for (const auto& value : values)
            add(value);
    }

    [[nodiscard]] uint64_t value() const { return hash_; }

private:
    uint64_t hash_ = 0xcbf29ce484222325u;
};

} // namespace tests
