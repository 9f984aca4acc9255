// Notes on softened cloths.
#include "samples/viewer/softening_notes.hpp"

#include "samples/viewer/text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace viewer
{
namespace
{

constexpr size_t k_most_notes = 20; // beyond it they only hide what else is said

// Never rounded up to all.
std::string percent(float fraction)
{
    const double value = fraction < 1 ? std::min(100 * static_cast<double>(fraction), 99.9) : 100;
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), value < 10 ? "%.2g %%" : "%.3g %%", value);
    return text.data();
}

void note_softening(const std::string& cloth, const voile::Stability& stability)
{
    std::string left = percent(stability.stiffness_scale) + " of its stiffness";
    if (stability.damping_scale < 1)
        left += " and " + percent(stability.damping_scale) + " of its damping";
    note("cloth " + in_quotes(cloth) + " needs " + std::to_string(stability.needed) + " substeps a frame and gets " +
         std::to_string(stability.used) + ": it has " + left);
}

} // namespace

void SofteningNotes::check(const Stage& stage, float duration)
{
    const voile::Solver& solver = stage.world->solver();
    voile::Step step = stage.world->step;
    step.duration = duration;
    if (step.substeps == 0)
        step.substeps = solver.stable_substeps(duration, step.max_substeps); // once, not for each cloth
    if (solver.stable_substeps(duration, UINT32_MAX) <= step.substeps)
        return;
    noted_.resize(stage.cloths.size());
    for (size_t i = 0; i < stage.cloths.size(); ++i)
    {
        if (noted_[i])
            continue;
        const voile::Stability stability = solver.stability(stage.cloths[i].id, step);
        if (stability.stiffness_scale >= 1 && stability.damping_scale >= 1)
            continue;
        noted_[i] = true;
        if (++count_ <= k_most_notes)
            note_softening(stage.cloths[i].name, stability);
        else if (count_ == k_most_notes + 1)
            note("more cloths are softened; --stats counts the substeps");
    }
}

} // namespace viewer
