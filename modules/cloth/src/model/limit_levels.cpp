// From the graphs of a cloth to the levels of its strain limit.
#include "model/limit_levels.hpp"

#include "model/cloth_model.hpp"
#include "model/coarser_graph.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace voile
{

namespace
{

constexpr size_t k_most_levels = 16;
constexpr size_t k_fewest_vertices = 4; // of a level

// 0 along warp and weft, 1 halfway between.
float shear_of(const FabricOffset& offset)
{
    const double squared = std::norm(offset);
    return squared > 0 ? static_cast<float>(std::abs(2 * offset.real() * offset.imag()) / squared) : 0;
}

// Of a link from vertex `i`, at the lower one of its ends. Both ends take the same bits: were their limits different by
// a rounding, one might move where the other does not.
FabricOffset lower_offset(const LimitGraph& level, uint32_t i, const LimitGraphLink& link)
{
    if (i < link.to)
        return link.offset;
    const std::span<const LimitGraphLink> others = level.links_of(link.to);
    return std::ranges::find(others, i, &LimitGraphLink::to)->offset;
}

float inverse(double mass)
{
    return mass > 0 ? static_cast<float>(1 / mass) : 0;
}

// The number of levels that are too large for limit_coarse.comp. The first always is.
uint32_t narrow_levels(std::span<const CoarserGraph> coarser)
{
    size_t narrow = coarser.size();
    while (narrow > 1 && coarser[narrow - 1].level.vertices.size() <= VOILE_LIMIT_COARSE_VERTICES)
        --narrow;
    return static_cast<uint32_t>(narrow);
}

// Entries for the vertices on all other levels. A level has those of the next wider one, and more.
std::vector<shared::LimitVertex> make_wide(std::vector<shared::LimitVertex>& vertices, uint32_t narrow)
{
    std::vector<shared::LimitVertex> wide;
    for (uint32_t i = 0; i < vertices.size(); ++i)
        if (vertices[i].top >= narrow)
        {
            wide.push_back(vertices[i]);
            wide.back().other = i;
        }
    std::ranges::stable_sort(wide, std::ranges::greater(), &shared::LimitVertex::top);
    for (uint32_t k = 0; k < wide.size(); ++k)
        vertices[wide[k].other].other = k;
    wide.resize(std::min<size_t>(vertices.size(), VOILE_LIMIT_COARSE_VERTICES));
    return wide;
}

// The levels in the layout that is uploaded, vertex by vertex.
LimitLevels packed(std::span<const CoarserGraph> coarser)
{
    const size_t count = coarser[0].level.vertices.size();
    std::vector<shared::LimitVertex> vertices(count);
    for (size_t l = 1; l < coarser.size(); ++l)
        for (const uint32_t vertex : coarser[l].level.vertices)
            vertices[vertex].top = static_cast<uint32_t>(l);
    uint32_t entries = 0;
    for (shared::LimitVertex& vertex : vertices)
    {
        vertex.first_level = entries;
        entries += vertex.top + 1;
    }
    std::vector<shared::LimitLevel> levels(entries);
    std::vector<shared::LimitLink> links;
    std::vector<shared::LimitParent> parents;
    for (size_t l = 0; l < coarser.size(); ++l)
    {
        const LimitGraph& level = coarser[l].level;
        for (uint32_t i = 0; i < level.vertices.size(); ++i)
        {
            const std::span<const LimitGraphLink> own = level.links_of(i);
            levels[vertices[level.vertices[i]].first_level + l] = {
                static_cast<uint32_t>(links.size()), static_cast<uint32_t>(own.size()), inverse(level.masses[i]), 0};
            for (const LimitGraphLink& link : own)
            {
                links.push_back({level.vertices[link.to], static_cast<float>(link.length),
                                 shear_of(lower_offset(level, i, link)), inverse(level.masses[link.to])});
            }
        }
        for (const LimitParents& leaving : coarser[l].parents)
        {
            shared::LimitVertex& vertex = vertices[coarser[l - 1].level.vertices[leaving.vertex]];
            vertex.first_parent = static_cast<uint32_t>(parents.size());
            vertex.parents = static_cast<uint32_t>(leaving.parents.size());
            for (const shared::LimitParent& parent : leaving.parents)
                parents.push_back({level.vertices[parent.vertex], parent.weight});
        }
    }
    const uint32_t narrow = narrow_levels(coarser);
    std::vector<shared::LimitVertex> wide = make_wide(vertices, narrow);
    return {std::move(vertices),
            std::move(wide),
            std::move(levels),
            std::move(links),
            std::move(parents),
            static_cast<uint32_t>(coarser.size()),
            narrow};
}

} // namespace

std::vector<uint32_t> pinned_vertices(const ClothModel& cloth)
{
    std::vector<uint32_t> pinned;
    const float near = cloth.record.springs[0].rest_length; // a distance that is shorter holds about as a pin does
    for (const Attachment& attachment : cloth.attachments)
        if (std::isinf(attachment.stiffness) || attachment.max_distance < near)
            pinned.push_back(attachment.vertex);
    for (uint32_t i = 0; i < cloth.start.size(); ++i)
        if (cloth.start[i].w == 0)
            pinned.push_back(i);
    std::ranges::sort(pinned);
    return pinned;
}

bool needs_limit_levels(const ClothModel& cloth)
{
    if (cloth.mesh || cloth.own_inverse_mass > 0)
        return true;
    const auto columns = static_cast<int>(cloth.record.columns);
    const auto rows = static_cast<int>(cloth.record.rows);
    const std::vector<uint32_t> pins = pinned_vertices(cloth);
    const auto is_pinned = [&](int column, int row)
    { return std::ranges::binary_search(pins, static_cast<uint32_t>(row * columns + column)); };
    for (const uint32_t pin : pins)
        for (int spacing = 2; spacing < std::max(columns, rows); spacing *= 2)
        {
            const int left = static_cast<int>(pin) % columns / spacing * spacing;
            const int top = static_cast<int>(pin) / columns / spacing * spacing;
            const int right = std::min(left + spacing, columns - 1);
            const int bottom = std::min(top + spacing, rows - 1);
            if (!is_pinned(left, top) && !is_pinned(right, top) && !is_pinned(left, bottom) &&
                !is_pinned(right, bottom))
                return true;
        }
    return false;
}

LimitLevels make_limit_levels(const ClothModel& cloth)
{
    std::vector<uint8_t> pinned(cloth.record.vertices);
    for (const uint32_t vertex : pinned_vertices(cloth))
        pinned[vertex] = 1;
    std::vector<CoarserGraph> all;
    all.push_back({make_limit_graph(cloth), {}});
    while (all.size() < k_most_levels && all.back().level.vertices.size() > k_fewest_vertices)
    {
        CoarserGraph next = coarsen(all.back().level, pinned);
        if (next.level.links.empty())
            break;
        all.push_back(std::move(next));
    }
    return packed(all);
}

} // namespace voile
