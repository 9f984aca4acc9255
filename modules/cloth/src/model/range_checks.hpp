// Checks of input values against their ranges, and the messages of values outside.
#pragma once

#include "voile/ranges.hpp"

#include "voile/result.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>

namespace voile
{

std::string subject(const std::string& what, const std::string& name); // cloth "name"
Error invalid(const std::string& what, const std::string& name, const std::string& reason);

struct Range
{
    const char* name;
    float value;
    float min;
    float max;
    const char* unit = ""; // with a blank before it
};

// With six digits, as short as possible.
std::string text(float value);
std::string text(const glm::vec3& value);

// Errors: a value that is not within, NaN among them. `what` says whose it is.
Result<void> check(const std::string& what, const Range& range);

// The same for each component; the error has all of them.
Result<void> check(const std::string& what, const char* name, const glm::vec3& value, float most,
                   const char* unit = "");

// Coulomb's coefficients: kinetic 0..k_most_friction, static from that on.
Result<void> check_friction(const std::string& what, float static_friction, float kinetic_friction);

// Errors: a value of an enumeration that is none of its names, which are those from 0 on.
Result<void> check_enumerator(const std::string& what, const char* name, int value,
                              std::initializer_list<const char*> names);

bool within(const glm::vec3& value, float most); // each component, either way; false for NaN

bool finite(const glm::vec3& v);
bool finite(const glm::mat4& m);

// Errors: an index that is not below `count`; `what` is "cloth", "collider" or "anchor".
Result<void> check_id(const char* what, uint32_t index, size_t count);

// A transform is finite and its last row 0 0 0 1.
Result<void> check_affine(const std::string& what, const glm::mat4& transform);

// The same, and its axes are within k_most_scale, its translation within `most` m.
Result<void> check_bounded(const std::string& what, const glm::mat4& transform, float most);

// Each position is within k_most_coordinate. The error names the first that is not: BEFORE + its index + AFTER.
Result<void> check_positions(const std::string& what, std::span<const glm::vec3> positions, const std::string& before,
                             const std::string& after);

// Errors: a position that is not finite, an index beyond the positions; `what` and `name` say whose.
Result<void> validate_triangles(const std::string& what, const std::string& name, std::span<const glm::vec3> positions,
                                std::span<const glm::uvec3> triangles);

} // namespace voile
