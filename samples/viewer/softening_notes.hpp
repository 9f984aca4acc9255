// Notes on cloths that the substeps are too few for: they stretch more than their material says.
#pragma once

#include "samples/viewer/stage.hpp"

#include <vector>

namespace viewer
{

class SofteningNotes
{
public:
    // Notes the cloths that a step of `duration` seconds softens, each once. Call it once per frame: what a cloth needs
    // may change while it runs.
    void check(const Stage& stage, float duration);

private:
    std::vector<bool> noted_; // one per cloth
    size_t count_ = 0;
};

} // namespace viewer
