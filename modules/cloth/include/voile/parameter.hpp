// The types of the table in material_parameters.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

namespace voile
{

// Access to a number within a material.
template <typename M>
struct MaterialMember
{
    const float& (*get)(const M&) = nullptr;
    float& (*ref)(M&) = nullptr;
};

// One number of a parameter that has several, such as warp and weft of stretch_stiffness.
template <typename M>
struct ParameterComponent
{
    const char* name = "";
    MaterialMember<M> member{};
};

// Rules of a parameter beside its range.
template <typename M>
struct ParameterRule
{
    bool or_zero = false; // 0 is valid as well, and means none
    // Another parameter of the same material, a lower bound for this one. Null: none.
    const char* least_name = nullptr;
    MaterialMember<M> least{};
};

template <typename M>
class MaterialParameter
{
public:
    const char* name; // of the member, and the key in scene files
    const char* unit; // "" for a ratio
    float min;
    float max;
    const char* meaning;
    ParameterRule<M> rule;

    constexpr MaterialParameter(const char* key, MaterialMember<M> member, const char* si_unit, float smallest,
                                float largest, const char* words, ParameterRule<M> more = {})
        : name(key), unit(si_unit), min(smallest), max(largest), meaning(words), rule(more), count_(1)
    {
        components_[0].member = member;
    }
    constexpr MaterialParameter(const char* key, std::initializer_list<ParameterComponent<M>> components,
                                const char* si_unit, float smallest, float largest, const char* words)
        : name(key), unit(si_unit), min(smallest), max(largest), meaning(words), count_(components.size())
    {
        size_t i = 0;
        for (const ParameterComponent<M>& component : components)
            components_[i++] = component;
    }

    [[nodiscard]] constexpr std::span<const ParameterComponent<M>> components() const
    {
        return {components_.data(), count_};
    }

private:
    size_t count_;
    std::array<ParameterComponent<M>, 6> components_{};
};

namespace parameter_path
{

// The member that a path leads to; a number in the path is an index.
template <auto First, auto... Rest, typename Owner>
constexpr auto& follow(Owner& owner)
{
    if constexpr (!std::is_member_object_pointer_v<decltype(First)>)
        return owner[First];
    else if constexpr (sizeof...(Rest) == 0)
        return owner.*First;
    else
        return follow<Rest...>(owner.*First);
}

template <typename Value, typename M>
M owner_of(Value M::*);

template <auto First>
using Owner = decltype(owner_of(First));

} // namespace parameter_path

template <auto First, auto... Rest>
inline constexpr MaterialMember<parameter_path::Owner<First>> k_member{
    [](const parameter_path::Owner<First>& m) -> const float& { return parameter_path::follow<First, Rest...>(m); },
    [](parameter_path::Owner<First>& m) -> float& { return parameter_path::follow<First, Rest...>(m); },
};

namespace parameter_path
{

template <typename P, size_t A, size_t B, size_t... I, size_t... J>
constexpr std::array<P, A + B> join(const std::array<P, A>& a, const std::array<P, B>& b, std::index_sequence<I...>,
                                    std::index_sequence<J...>)
{
    return {a[I]..., b[J]...};
}

template <typename P, size_t A, size_t B>
constexpr std::array<P, A + B> join(const std::array<P, A>& a, const std::array<P, B>& b)
{
    return join(a, b, std::make_index_sequence<A>{}, std::make_index_sequence<B>{});
}

template <typename P, size_t N>
constexpr size_t numbers(const std::array<P, N>& parameters)
{
    size_t count = 0;
    for (const P& parameter : parameters)
        count += parameter.components().size();
    return count;
}

} // namespace parameter_path

// The parameter of that name; null if the material has none.
template <size_t N, typename M>
constexpr const MaterialParameter<M>* find_parameter(const std::array<MaterialParameter<M>, N>& parameters,
                                                     std::string_view name)
{
    for (const MaterialParameter<M>& parameter : parameters)
        if (name == parameter.name)
            return &parameter;
    return nullptr;
}

} // namespace voile
