#include "model/pair_order.hpp"

#include "geometry/bvh_split.hpp"

#include <algorithm>
#include <numeric>

namespace voile
{

namespace
{

int longest_axis(const glm::vec3& size)
{
    if (size.x >= size.y && size.x >= size.z)
        return 0;
    return size.y >= size.z ? 1 : 2;
}

void halve(std::span<const glm::vec4> positions, std::span<uint32_t> range)
{
    if (range.size() < 3)
        return;
    Box box;
    for (const uint32_t i : range)
        box.add(glm::vec3(positions[i]));
    const int axis = longest_axis(box.max - box.min);
    const size_t half = (range.size() + 1) / 2;
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(half), range.end(),
                     [&](uint32_t a, uint32_t b)
                     {
                         const float x = positions[a][axis];
                         const float y = positions[b][axis];
                         return x != y ? x < y : a < b;
                     });
    halve(positions, range.first(half));
    halve(positions, range.subspan(half));
}

} // namespace

std::vector<uint32_t> make_pair_order(std::span<const glm::vec4> positions)
{
    std::vector<uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    halve(positions, order);
    return order;
}

} // namespace voile
