// Some of a graph's vertices, about two links apart, with links along the shortest paths between them. Paths unroll
// into a plane: each link knows how far the frame at its other end is turned. So links are as long as the fabric
// between their ends, however the cloth is bent at rest.
#include "model/coarser_graph.hpp"

#include "geometry/parallel.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace voile
{

namespace
{

constexpr size_t k_least_coarse_vertices = 1024; // vertices per thread
constexpr uint32_t k_most_links = 12; // of a vertex on a level but the first, and those that others have to it
constexpr uint32_t k_most_parents = 6;
constexpr uint32_t k_hops = 3; // of the paths to neighbors on the next level, and to parents
// Around a vertex that stays on the next level, others within this part of the mean length of its links leave: of the
// squares of a grid those beside it and those across.
constexpr double k_cover = 1.5;
// A neighbor is hidden behind a nearer one if that is within this part of its distance.
constexpr double k_hidden = 0.5;
// Paths that go straight between neighbors are at most so much longer than their distance.
constexpr double k_zigzag = 1.16;
// A path that is so much longer goes around a hole or a corner: the cloth is not flat between its ends.
constexpr double k_detour = 1.3;
constexpr double k_farthest_parent = 2.3; // times the distance of the nearest

constexpr uint32_t k_none = 0xffffffff;

// Shortest paths from one vertex of a level, of few links.
class Paths
{
public:
    explicit Paths(const LimitGraph& level) : level_(level), places_(level.vertices.size(), k_none) {}

    // `to` of the first is the vertex itself.
    std::span<const LimitGraphLink> from(uint32_t start, uint32_t hops)
    {
        for (const LimitGraphLink& path : found_)
            places_[path.to] = k_none;
        found_.assign(1, {start, 0, 1, 0});
        places_[start] = 0;
        size_t begin = 0;
        for (uint32_t hop = 0; hop < hops; ++hop)
        {
            const size_t end = found_.size();
            for (size_t i = begin; i < end; ++i)
                extend(found_[i]);
            begin = end;
        }
        return found_;
    }

private:
    void extend(const LimitGraphLink path)
    {
        for (const LimitGraphLink& link : level_.links_of(path.to))
        {
            const LimitGraphLink longer{link.to, path.offset + path.turn * link.offset, path.turn * link.turn,
                                        path.length + link.length};
            if (places_[link.to] == k_none)
            {
                places_[link.to] = static_cast<uint32_t>(found_.size());
                found_.push_back(longer);
            }
            else if (longer.length < found_[places_[link.to]].length)
                found_[places_[link.to]] = longer;
        }
    }

    const LimitGraph& level_;
    std::vector<uint32_t> places_; // in found_
    std::vector<LimitGraphLink> found_;
};

double mean_length(std::span<const LimitGraphLink> links)
{
    double sum = 0;
    for (const LimitGraphLink& link : links)
        sum += link.length;
    return sum / std::max(1.0, static_cast<double>(links.size()));
}

// Of each vertex of a level, its index among those of the next one, or k_none. Each that leaves is near one that stays.
std::vector<uint32_t> choose(const LimitGraph& level, std::span<const uint8_t> pinned)
{
    const auto count = static_cast<uint32_t>(level.vertices.size());
    enum State : uint8_t
    {
        undecided,
        stays,
        leaves
    };
    std::vector<State> states(count, undecided);
    // Those beside them that leave are next, so that those that stay lie close.
    Paths paths(level);
    std::vector<uint32_t> front;
    size_t decided = 0;
    const auto decide = [&](uint32_t i)
    {
        if (states[i] != undecided)
            return;
        states[i] = level.links_of(i).empty() ? leaves : stays;
        const double radius = k_cover * mean_length(level.links_of(i));
        for (const LimitGraphLink& path : paths.from(i, k_hops).subspan(1))
        {
            if (states[path.to] == undecided && std::abs(path.offset) <= radius)
                states[path.to] = leaves;
            else if (states[path.to] == undecided)
                front.push_back(path.to);
        }
    };
    for (const bool pins : {true, false})
        for (uint32_t i = 0; i < count; ++i)
        {
            if ((pinned[level.vertices[i]] != 0) != pins)
                continue;
            decide(i);
            while (!pins && decided < front.size())
                decide(front[decided++]);
        }
    std::vector<uint32_t> next(count, k_none);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (states[i] == stays)
            next[i] = kept++;
    return next;
}

// m: between the ends of a path, along the cloth. Never longer than the path; the cloth is never stretched by more than
// k_zigzag if it is shorter than that.
double straightened(const LimitGraphLink& path)
{
    const double straight = std::abs(path.offset);
    return path.length > k_detour * straight ? path.length : std::max(straight, path.length / k_zigzag);
}

// The ends that stay on the next level, nearest first.
std::vector<LimitGraphLink> candidates(std::span<const LimitGraphLink> paths, std::span<const uint32_t> next)
{
    std::vector<LimitGraphLink> result;
    for (const LimitGraphLink& path : paths.subspan(1))
        if (next[path.to] != k_none)
            result.push_back({next[path.to], path.offset, path.turn, straightened(path)});
    std::ranges::sort(result, {}, [](const LimitGraphLink& link) { return std::pair(link.length, link.to); });
    return result;
}

struct Pair
{
    uint32_t a; // lower than link.to
    LimitGraphLink link;
};

Pair ordered(uint32_t vertex, const LimitGraphLink& link)
{
    if (vertex < link.to)
        return {vertex, link};
    return {link.to, {vertex, reversed(link), std::conj(link.turn), link.length}};
}

void add_neighbors(std::vector<Pair>& pairs, uint32_t vertex, std::span<const LimitGraphLink> candidates)
{
    std::vector<LimitGraphLink> chosen;
    for (const LimitGraphLink& link : candidates)
    {
        const auto hides = [&](const LimitGraphLink& nearer)
        { return std::abs(link.offset - nearer.offset) < k_hidden * std::abs(link.offset); };
        if (chosen.size() < k_most_links && std::ranges::none_of(chosen, hides))
            chosen.push_back(link);
    }
    for (const LimitGraphLink& link : chosen)
        pairs.push_back(ordered(vertex, link));
}

// Calls body(paths, i, out) for the vertices of a level, those of a piece on one thread. Returns what they put out.
template <typename Out, typename Body>
std::vector<Out> for_each_vertex(const LimitGraph& level, const Body& body)
{
    const size_t piece = piece_per_thread(level.vertices.size(), k_least_coarse_vertices);
    std::vector<std::vector<Out>> pieces((level.vertices.size() + piece - 1) / piece);
    parallel_for(level.vertices.size(), piece,
                 [&](size_t begin, size_t end)
                 {
                     Paths paths(level);
                     for (size_t i = begin; i < end; ++i)
                         body(paths, static_cast<uint32_t>(i), pieces[begin / piece]);
                 });
    std::vector<Out> all;
    for (const std::vector<Out>& some : pieces)
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

// Both ends of a pair have the link, whoever chose it.
void set_links(LimitGraph& level, std::vector<Pair> pairs)
{
    const auto ends = [](const Pair& pair) { return std::pair(pair.a, pair.link.to); };
    std::ranges::stable_sort(pairs, {}, ends);
    pairs.erase(
        std::unique(pairs.begin(), pairs.end(), [&](const Pair& p, const Pair& q) { return ends(p) == ends(q); }),
        pairs.end());
    level.first.assign(level.vertices.size() + 1, 0);
    for (const Pair& pair : pairs)
    {
        ++level.first[pair.a + 1];
        ++level.first[pair.link.to + 1];
    }
    std::partial_sum(level.first.begin(), level.first.end(), level.first.begin());
    level.links.resize(2 * pairs.size());
    std::vector<uint32_t> filled(level.first.begin(), level.first.end() - 1);
    for (const Pair& pair : pairs)
    {
        level.links[filled[pair.a]++] = pair.link;
        const LimitGraphLink back{pair.a, reversed(pair.link), std::conj(pair.link.turn), pair.link.length};
        level.links[filled[pair.link.to]++] = back;
    }
}

// Weights that sum to 1 and whose mean of the offsets is 0, so that a displacement that is linear between parents is
// exact: w_i = (l_0 + l . offset_i) / distance_i^2, the least sum of (w_i distance_i)^2. False: there are none.
bool set_linear_weights(std::span<const LimitGraphLink> near, std::span<double> weights)
{
    glm::dmat3 m(0);
    for (const LimitGraphLink& link : near)
    {
        const glm::dvec3 row(1, link.offset.real(), link.offset.imag());
        m += glm::outerProduct(row, row) / std::max(std::norm(link.offset), 1e-30);
    }
    const double scale = m[0].x;
    if (!(glm::determinant(m) > 1e-6 * scale))
        return false;
    const glm::dvec3 l = glm::inverse(m)[0];
    bool positive = true;
    for (size_t i = 0; i < near.size(); ++i)
    {
        const glm::dvec3 row(1, near[i].offset.real(), near[i].offset.imag());
        weights[i] = glm::dot(l, row) / std::max(std::norm(near[i].offset), 1e-30);
        positive = positive && weights[i] >= 0;
    }
    return positive;
}

LimitParents parents_of(uint32_t vertex, std::span<const LimitGraphLink> candidates)
{
    LimitParents result{vertex, {}};
    size_t count = 0;
    while (count < std::min<size_t>(k_most_parents, candidates.size()) &&
           candidates[count].length <= k_farthest_parent * candidates[0].length)
        ++count;
    const std::span<const LimitGraphLink> near = candidates.first(count);
    std::array<double, k_most_parents> weights{};
    if (!set_linear_weights(near, weights))
        for (size_t i = 0; i < count; ++i)
            weights[i] = 1 / std::max(near[i].length * near[i].length, 1e-30);
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
        sum += weights[i];
    for (size_t i = 0; i < count; ++i)
        if (weights[i] > 0)
            result.parents.push_back({near[i].to, static_cast<float>(weights[i] / sum)});
    return result;
}

} // namespace

CoarserGraph coarsen(const LimitGraph& fine, std::span<const uint8_t> pinned)
{
    const std::vector<uint32_t> next = choose(fine, pinned);
    CoarserGraph result;
    for (uint32_t i = 0; i < next.size(); ++i)
        if (next[i] != k_none)
        {
            result.level.vertices.push_back(fine.vertices[i]);
            result.level.masses.push_back(fine.masses[i]);
        }
    set_links(result.level, for_each_vertex<Pair>(fine,
                                                  [&](Paths& paths, uint32_t i, std::vector<Pair>& out)
                                                  {
                                                      if (next[i] != k_none)
                                                          add_neighbors(out, next[i],
                                                                        candidates(paths.from(i, k_hops), next));
                                                  }));
    result.parents = for_each_vertex<LimitParents>(fine,
                                                   [&](Paths& paths, uint32_t i, std::vector<LimitParents>& out)
                                                   {
                                                       if (next[i] != k_none || fine.links_of(i).empty())
                                                           return;
                                                       auto near = candidates(paths.from(i, k_hops - 1), next);
                                                       if (near.empty())
                                                           near = candidates(paths.from(i, k_hops), next);
                                                       out.push_back(parents_of(i, near));
                                                   });
    for (const LimitParents& fine_vertex : result.parents)
        for (const shared::LimitParent& parent : fine_vertex.parents)
            if (pinned[fine.vertices[fine_vertex.vertex]] == 0)
                result.level.masses[parent.vertex] +=
                    static_cast<double>(parent.weight) * fine.masses[fine_vertex.vertex];
    return result;
}

} // namespace voile
