// Result<T>: a value, or the reason why there is none, with the interface of std::expected<T, Error>. Only
// std::bad_alloc is thrown across a module's boundary; the object whose call threw it may then only be destroyed.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace voile
{

// The input (file, line, index, value) and what is wrong with it, in one line without a full stop.
struct Error
{
    std::string message;
};

template <typename T>
class [[nodiscard]] Result
{
public:
    using value_type = T;
    using error_type = Error;

    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    // Throws std::bad_variant_access if there is no value, which is a bug of the caller.
    [[nodiscard]] T& value() & { return std::get<0>(state_); }
    [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
    [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }

    // Only valid if there is a value.
    [[nodiscard]] T& operator*() & noexcept { return *std::get_if<0>(&state_); }
    [[nodiscard]] const T& operator*() const& noexcept { return *std::get_if<0>(&state_); }
    [[nodiscard]] T&& operator*() && noexcept { return std::move(*std::get_if<0>(&state_)); }
    [[nodiscard]] T* operator->() noexcept { return std::get_if<0>(&state_); }
    [[nodiscard]] const T* operator->() const noexcept { return std::get_if<0>(&state_); }

    // Only valid if there is no value.
    [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

    template <typename U>
    [[nodiscard]] T value_or(U&& fallback) const&
    {
        return has_value() ? **this : static_cast<T>(std::forward<U>(fallback));
    }
    template <typename U>
    [[nodiscard]] T value_or(U&& fallback) &&
    {
        return has_value() ? *std::move(*this) : static_cast<T>(std::forward<U>(fallback));
    }

    // Calls `next` with the value. `next` returns a Result. An error is passed on.
    template <typename F>
    auto and_then(F&& next) const& -> std::remove_cvref_t<std::invoke_result_t<F, const T&>>
    {
        if (!has_value())
            return error();
        return std::forward<F>(next)(**this);
    }
    template <typename F>
    auto and_then(F&& next) && -> std::remove_cvref_t<std::invoke_result_t<F, T&&>>
    {
        if (!has_value())
            return error();
        return std::forward<F>(next)(*std::move(*this));
    }

    // A Result of what `change` makes of the value. An error is passed on.
    template <typename F>
    auto transform(F&& change) const& -> Result<std::remove_cvref_t<std::invoke_result_t<F, const T&>>>
    {
        if (!has_value())
            return error();
        return std::forward<F>(change)(**this);
    }
    template <typename F>
    auto transform(F&& change) && -> Result<std::remove_cvref_t<std::invoke_result_t<F, T&&>>>
    {
        if (!has_value())
            return error();
        return std::forward<F>(change)(*std::move(*this));
    }

private:
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void>
{
public:
    using value_type = void;
    using error_type = Error;

    Result() = default;
    Result(Error error) : state_(std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }
    // Throws std::bad_variant_access on an error.
    void value() const { static_cast<void>(std::get<0>(state_)); }
    // Only valid if there is one.
    [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

    // Calls `next`, which returns a Result. An error is passed on.
    template <typename F>
    auto and_then(F&& next) const -> std::remove_cvref_t<std::invoke_result_t<F>>
    {
        if (!has_value())
            return error();
        return std::forward<F>(next)();
    }

private:
    std::variant<std::monostate, Error> state_;
};

} // namespace voile
