// ClothModel: one cloth on the host, with arrays of its own in the layout that is uploaded.
#pragma once

#include "voile/attachments.hpp"
#include "voile/descriptions.hpp"

#include "model/limit_levels.hpp"
#include "model/mesh_fans.hpp"
#include "model/mesh_lists.hpp"
#include "model/mesh_topology.hpp"
#include "model/range_checks.hpp"
#include "shared/attachment_layout.h"
#include "shared/cloth_layout.h"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace voile
{

struct PaddedTree; // geometry/padded_tree.hpp

// An axis-aligned box around positions; empty at first.
struct Extent
{
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    void join(const Extent& other)
    {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
    [[nodiscard]] bool empty() const { return min.x > max.x; }
};

// Offsets in `record` (first_vertex, first_list, first_fan, first_limit) are those of the solver's buffers. They stay
// as long as the cloth.
struct ClothModel
{
    std::string name;
    bool enabled = true;
    bool self_collision = false;
    bool uploaded = false;      // its arrays are in the solver's buffers
    uint32_t level = 0;         // of its substeps (substep_plan.hpp)
    bool jumped = false;        // reset or teleported in the step that is recorded
    float softened_substep = 0; // s, of the last step (Softening)
    bool softening_due = false; // that in the record changed with the steps
    bool limit_due = false;     // the strain limit in the record changed with the substeps
    bool wake_due = false;      // it must not sleep in the next step
    ClothMaterial material;
    Integrator integrator = Integrator::rk4;
    std::shared_ptr<const MeshTopology> mesh;        // none: a grid. Instances of a cooked cloth share it
    std::shared_ptr<const MeshLists> lists;          // of a mesh, as they are uploaded; shared, too
    std::shared_ptr<const MeshFans> fans;            // of a mesh that collides with itself; shared, too
    std::shared_ptr<const LimitLevels> limit_levels; // from the first upload on, if they are listed; shared, too
    glm::vec2 spacing{0.f};                          // m, of a grid along a row and along a column
    // Masses that the host gave, relative to those of the material: the largest inverse mass in 1/kg times the vertex's
    // area (Fabric) or mass scale (Material). 0: all are the material's.
    double own_inverse_mass = 0;
    float heaviest = 0;                  // the least `start.w` that is not 0; 0: there is none
    glm::vec3 velocity{0.f};             // m/s, at the start
    std::vector<Attachment> attachments; // pins and others, in the order given
    std::optional<Tethers> tether_options;
    std::vector<shared::TetherRecord> tethers;

    shared::ClothRecord record{};
    std::vector<glm::vec4> start;      // positions; w: inverse of the area or mass scale that the density multiplies
    std::vector<glm::uvec2> residuals; // of the positions at the start (fine_position.glsl)
    std::vector<glm::vec4> positions;  // at the start; w: inverse mass, 0 if pinned. Empty once they are uploaded
    std::vector<glm::vec4> velocities; // at the start. Empty once they are uploaded
    std::vector<uint32_t> pair_order;  // of a cloth that collides with itself: its vertices, near ones together
    Extent extent;                     // m, of the positions at the start
    float longest_edge = 0;            // m, at the start; of a grid the diagonal of a cell
    uint64_t first_triangle = 0;       // in the index buffer, if there is one
    std::shared_ptr<const PaddedTree> tree; // with SolverOptions::intersections or self_collision; instances share it
    uint64_t first_boxes = 0;               // the range of its boxes, with the room for their alignment
};

// The input that grids and meshes have in common: transform, velocity, material, pinned vertices, inverse masses.
struct ClothInput
{
    const std::string& name;
    const glm::mat4& transform;
    const glm::vec3& velocity;
    const ClothMaterial& material;
    Integrator integrator;
    std::span<const uint32_t> pins;
    std::span<const float> inverse_masses;
    float sleep_speed;
};
Result<void> validate(const ClothInput& cloth, uint64_t vertices);

// Errors: out of its range.
Result<void> check_sleep_speed(const std::string& cloth, float speed);

// Errors: the transform of the cloth takes one of them out of range.
Result<void> check_world_positions(const std::string& cloth, std::span<const glm::dvec3> world);
// A rotation in floats stretches by some 1e-7, which stiff springs feel. What is that near to a rigid transform is made
// one exactly.
glm::dmat4 without_rounding(const glm::mat4& transform);

// Areal density of a fabric, kg/m^2, or the mass of a vertex, kg.
double density(const ClothMaterial& material);

// Whether a material bends by the isometric model.
bool bends_isometrically(const ClothMaterial& material);

// Sets the members of the record that follow from the material, not offsets (first_vertex, first_list, first_fan) and
// sizes.
void apply_material(ClothModel& cloth);

// Sets the widest level that limit_strain.comp takes.
void set_strain_spacing(ClothModel& cloth);

// Fills the start of a cloth whose record is complete: masses from the material unless they are given.
void set_start(ClothModel& cloth, const ClothInput& input, std::span<const glm::dvec3> world_positions);

uint64_t count_triangles(const ClothModel& cloth);
// Triangles of a cloth, a grid's cut as Solver::triangles says.
std::vector<glm::uvec3> cloth_triangles(const ClothModel& cloth);

} // namespace voile
