// SharedArray: values that never change and that several owners share.
#pragma once

#include "geometry/uninitialized_array.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace voile
{

// Copies share the values. They lie in a vector or array that was moved in, or in memory of another owner, such as
// cooked data, which is not copied.
template <typename T>
class SharedArray
{
public:
    SharedArray() = default;
    SharedArray(std::vector<T> values)
    {
        auto kept = std::make_shared<const std::vector<T>>(std::move(values));
        values_ = *kept;
        owner_ = std::move(kept);
    }
    SharedArray(UninitializedArray<T> values) : values_(values) { owner_ = std::shared_ptr<T[]>(values.release()); }
    // `owner` keeps the values alive.
    SharedArray(std::span<const T> values, std::shared_ptr<const void> owner)
        : values_(values), owner_(std::move(owner))
    {
    }

    [[nodiscard]] size_t size() const { return values_.size(); }
    [[nodiscard]] bool empty() const { return values_.empty(); }
    [[nodiscard]] const T* data() const { return values_.data(); }
    [[nodiscard]] const T* begin() const { return values_.data(); }
    [[nodiscard]] const T* end() const { return values_.data() + values_.size(); }
    [[nodiscard]] const T& front() const { return values_.front(); }
    [[nodiscard]] const T& back() const { return values_.back(); }
    const T& operator[](size_t i) const { return values_[i]; }

private:
    std::span<const T> values_;
    std::shared_ptr<const void> owner_;
};

} // namespace voile
