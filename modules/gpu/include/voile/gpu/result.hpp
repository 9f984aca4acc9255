// Result<T>: a value, or the reason why there is none. Only std::bad_alloc is thrown across a module's boundary.
// Afterwards the object whose call threw may only be destroyed.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace voile::gpu
{

// Names the faulty input (file, line, index, value) and the reason, in one line without a full stop.
struct Error
{
    std::string message;
};

template <typename T>
class [[nodiscard]] Result
{
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    // Only valid if ok(); std::bad_variant_access otherwise, which is a bug of the caller.
    [[nodiscard]] T& value() { return std::get<0>(state_); }
    [[nodiscard]] const T& value() const { return std::get<0>(state_); }

    // Only valid if not ok().
    [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

private:
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void>
{
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), ok_(false) {}

    [[nodiscard]] bool ok() const { return ok_; }
    explicit operator bool() const { return ok_; }
    [[nodiscard]] const Error& error() const { return error_; }

private:
    Error error_;
    bool ok_ = true;
};

} // namespace voile::gpu
