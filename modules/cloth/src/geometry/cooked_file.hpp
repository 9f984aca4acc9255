// Cooked data as bytes: a header with a version and a checksum, then arrays as they lie in memory.
#pragma once

#include "voile/result.hpp"

#include "geometry/parallel.hpp"
#include "geometry/shared_array.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace voile
{

enum class CookedKind : uint32_t
{
    cloth = 1,
    collider = 2,
};

// Of everything that follows a header. Whoever changes an array's meaning or layout raises it.
constexpr uint32_t k_cooked_version = 1;
constexpr size_t k_cooked_alignment = 16; // of every array, from the first byte on

class CookedWriter
{
public:
    explicit CookedWriter(CookedKind kind);

    template <typename T>
    void add(std::span<const T> values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        const size_t begin = aligned_end();
        bytes_.resize(begin + values.size_bytes());
        if (!values.empty())
            std::memcpy(bytes_.data() + begin, values.data(), values.size_bytes());
    }
    template <typename T>
    void add(const T& value)
    {
        add(std::span(&value, 1));
    }

    // The finished bytes.
    std::vector<std::byte> finish();

private:
    [[nodiscard]] size_t aligned_end() const
    {
        return (bytes_.size() + k_cooked_alignment - 1) / k_cooked_alignment * k_cooked_alignment;
    }

    std::vector<std::byte> bytes_;
};

// Writes the length and the checksum into the header of what a CookedWriter wrote.
void sign_cooked(std::span<std::byte> bytes);

// Reads what a CookedWriter wrote, in the same order. Nothing is copied but single values.
class CookedReader
{
public:
    // Errors: not cooked data, another kind, version or byte order, a wrong length, a wrong checksum. `bytes` begin at
    // a multiple of k_cooked_alignment.
    static Result<CookedReader> open(std::span<const std::byte> bytes, CookedKind kind);

    // The next `count` values; none, and ok() from then on false, where the bytes end before.
    template <typename T>
    std::span<const T> take(uint64_t count)
    {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= k_cooked_alignment);
        next_ = (next_ + k_cooked_alignment - 1) / k_cooked_alignment * k_cooked_alignment;
        if (!ok_ || next_ > bytes_.size() || count > (bytes_.size() - next_) / sizeof(T))
        {
            ok_ = false;
            return {};
        }
        const auto* first = reinterpret_cast<const T*>(bytes_.data() + next_);
        next_ += count * sizeof(T);
        return {first, static_cast<size_t>(count)};
    }
    template <typename T>
    T take()
    {
        T value{};
        if (const auto found = take<T>(1); !found.empty())
            std::memcpy(&value, found.data(), sizeof(T));
        return value;
    }

    // Whether everything was there, and nothing is left.
    [[nodiscard]] bool ok() const { return ok_ && next_ == bytes_.size(); }

private:
    explicit CookedReader(std::span<const std::byte> bytes);

    std::span<const std::byte> bytes_;
    size_t next_ = 0;
    bool ok_ = true;
};

// Bytes as a reader wants them: those of `owner`, or a copy if there is none or they begin elsewhere.
struct CookedBytes
{
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner;
};
CookedBytes keep_cooked(std::span<const std::byte> bytes, std::shared_ptr<const void> owner);

// Whether every value is as `check` wants it.
template <typename T, typename Check>
bool all_of(const SharedArray<T>& values, const Check& check)
{
    constexpr size_t k_piece = 65536;
    std::atomic<bool> all = true;
    parallel_for(values.size(), k_piece,
                 [&](size_t first, size_t last)
                 {
                     bool piece = true;
                     for (size_t i = first; i < last; ++i)
                         piece &= check(values[i]);
                     if (!piece)
                         all = false;
                 });
    return all;
}

} // namespace voile
