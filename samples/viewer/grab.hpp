// Grab: the mouse pulls at the cloth.
#pragma once

#include "samples/viewer/picking.hpp"
#include "samples/viewer/stage.hpp"

namespace viewer
{

// Springs pull the vertices around the picked one to an anchor, which follows the cursor in the plane that faces the
// camera. They are soft: a cloth that hangs from them alone sags by 3 % of its size.
class Grab
{
public:
    Grab(voile::engine::App& app, const Stage& stage, const std::vector<Solid>& solids)
        : app_(app), stage_(stage), solids_(solids)
    {
    }

    // Picks the cloth under the cursor. Waits for the device. False: there is none, a solid hides it, or the solver
    // refuses the springs.
    bool begin(const glm::vec2& cursor);
    void move(const glm::vec2& cursor);
    void end();
    // The solver that had the springs is gone.
    void forget() { anchor_.reset(); }

    [[nodiscard]] bool active() const { return anchor_.has_value(); }

private:
    struct Target
    {
        size_t cloth = 0; // its number on stage
        uint32_t vertex = 0;
        std::vector<glm::vec4> positions; // of the cloth
    };
    [[nodiscard]] std::optional<Target> pick(const Ray& ray) const;
    [[nodiscard]] bool hidden(const Ray& ray, float distance) const; // by a solid
    [[nodiscard]] Ray ray_at(const glm::vec2& cursor) const;

    voile::engine::App& app_;
    const Stage& stage_;
    const std::vector<Solid>& solids_;
    std::optional<voile::AnchorId> anchor_;
    glm::vec3 point_{0.f}; // m, of the anchor
};

} // namespace viewer
