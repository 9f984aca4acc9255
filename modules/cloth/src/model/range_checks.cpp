// Checks of input values against their ranges, and the messages of values outside.
#include "model/range_checks.hpp"

#include "voile/gpu/printable.hpp"

#include "voile/ids.hpp"

#include <cmath>
#include <cstdio>

namespace voile
{

std::string text(float value)
{
    char buffer[32];
    std::snprintf(buffer, sizeof(buffer), "%g", static_cast<double>(value));
    return buffer;
}

std::string text(const glm::vec3& v)
{
    return '(' + text(v.x) + ", " + text(v.y) + ", " + text(v.z) + ')';
}

Result<void> check(const std::string& what, const Range& range)
{
    if (range.value >= range.min && range.value <= range.max) // false for NaN
        return {};
    return Error{what + ": " + range.name + " is " + text(range.value) + range.unit + ", must be " + text(range.min) +
                 " to " + text(range.max)};
}

Result<void> check(const std::string& what, const char* name, const glm::vec3& value, float most, const char* unit)
{
    if (within(value, most))
        return {};
    return Error{what + ": " + name + " is " + text(value) + unit + ", each must be " + text(-most) + " to " +
                 text(most)};
}

Result<void> check_friction(const std::string& what, float static_friction, float kinetic_friction)
{
    if (auto result = check(what, {"kinetic_friction", kinetic_friction, 0, k_most_friction}); !result)
        return result;
    if (!(static_friction >= kinetic_friction))
        return Error{what + ": static_friction is " + text(static_friction) + ", must be at least kinetic_friction, " +
                     text(kinetic_friction)};
    return check(what, {"static_friction", static_friction, 0, k_most_friction});
}

Result<void> check_enumerator(const std::string& what, const char* name, int value,
                              std::initializer_list<const char*> names)
{
    if (value >= 0 && value < static_cast<int>(names.size()))
        return {};
    std::string choice;
    for (const char* const* one = names.begin(); one != names.end(); ++one)
        choice += (one == names.begin() ? "" : one + 1 == names.end() ? " or " : ", ") + std::string(*one);
    return Error{what + ": " + name + " is " + std::to_string(value) + ", must be " + choice};
}

bool within(const glm::vec3& value, float most)
{
    return std::abs(value.x) <= most && std::abs(value.y) <= most && std::abs(value.z) <= most;
}

bool finite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const glm::mat4& m)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row]))
                return false;
    return true;
}

Result<void> check_id(const char* what, uint32_t index, size_t count)
{
    if (index < count)
        return {};
    if (index == k_no_index)
        return Error{std::string(what) + ": the id is a default-constructed one"};
    return Error{std::string(what) + " " + std::to_string(index) + " does not exist"};
}

Result<void> check_affine(const std::string& what, const glm::mat4& transform)
{
    if (!finite(transform))
        return Error{what + ": its transform is not finite"};
    if (transform[0].w != 0 || transform[1].w != 0 || transform[2].w != 0 || transform[3].w != 1)
        return Error{what + ": its transform's last row is not 0 0 0 1"};
    return {};
}

Result<void> check_bounded(const std::string& what, const glm::mat4& transform, float most)
{
    if (auto affine = check_affine(what, transform); !affine)
        return affine;
    for (int column = 0; column < 3; ++column)
        if (auto axis = check(what, "an axis of its transform", glm::vec3(transform[column]), k_most_scale); !axis)
            return axis;
    return check(what, "its transform's translation", glm::vec3(transform[3]), most, " m");
}

Result<void> check_positions(const std::string& what, std::span<const glm::vec3> positions, const std::string& before,
                             const std::string& after)
{
    for (size_t i = 0; i < positions.size(); ++i)
        if (!within(positions[i], k_most_coordinate))
            return Error{what + ": " + before + std::to_string(i) + after + text(positions[i]) + ", each must be " +
                         text(-k_most_coordinate) + " to " + text(k_most_coordinate) + " m"};
    return {};
}

std::string subject(const std::string& what, const std::string& name)
{
    return what + " \"" + gpu::printable(name) + "\"";
}

Error invalid(const std::string& what, const std::string& name, const std::string& reason)
{
    return Error{subject(what, name) + ": " + reason};
}

Result<void> validate_triangles(const std::string& what, const std::string& name, std::span<const glm::vec3> positions,
                                std::span<const glm::uvec3> triangles)
{
    for (size_t i = 0; i < positions.size(); ++i)
        if (!finite(positions[i]))
            return invalid(what, name, "position " + std::to_string(i) + " is not finite");
    for (size_t t = 0; t < triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            if (triangles[t][corner] >= positions.size())
                return invalid(what, name,
                               "triangle " + std::to_string(t) + " refers to position " +
                                   std::to_string(triangles[t][corner]) + " of " + std::to_string(positions.size()));
    return {};
}

} // namespace voile
