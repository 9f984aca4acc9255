// UninitializedArray: memory for values that are all written before they are read.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace voile
{

// Threads that fill it together are the first to touch their parts, so they share the page faults as well.
template <typename T>
class UninitializedArray
{
    static_assert(std::is_trivially_copyable_v<T>);

public:
    UninitializedArray() = default;
    explicit UninitializedArray(size_t size) : values_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}

    [[nodiscard]] size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] T* data() { return values_.get(); }
    [[nodiscard]] const T* data() const { return values_.get(); }
    [[nodiscard]] T* begin() { return values_.get(); }
    [[nodiscard]] const T* begin() const { return values_.get(); }
    [[nodiscard]] T* end() { return values_.get() + size_; }
    [[nodiscard]] const T* end() const { return values_.get() + size_; }
    T& operator[](size_t i) { return values_[i]; }
    const T& operator[](size_t i) const { return values_[i]; }

    // Gives the memory away.
    [[nodiscard]] std::unique_ptr<T[]> release()
    {
        size_ = 0;
        return std::move(values_);
    }

private:
    std::unique_ptr<T[]> values_;
    size_t size_ = 0;
};

} // namespace voile
