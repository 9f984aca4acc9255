// A mesh as cloth in double precision on the CPU, from the model's formulas alone: one map of edges, one loop over
// triangles. A fabric's stretch and shear are springs along four directions of each triangle.
#pragma once

#include "bending_reference.hpp"
#include "cloth_reference.hpp"

#include <map>
#include <utility>

namespace reference
{

class MeshCloth
{
public:
    explicit MeshCloth(const voile::MeshCloth& mesh) : triangles_(mesh.triangles.begin(), mesh.triangles.end())
    {
        for (const glm::vec3& p : mesh.positions)
            rest_.emplace_back(glm::vec3(mesh.transform * glm::vec4(p, 1))); // stored in float
        find_second_axis(mesh);
        state = {rest_, std::vector<glm::dvec3>(rest_.size(), glm::dvec3(mesh.velocity))};
        const double flat = 1e-6; // of the longest edge squared; see mesh_topology.cpp
        std::erase_if(triangles_,
                      [&](const glm::uvec3& t)
                      {
                          const double longest =
                              std::max({glm::distance(rest_[t.x], rest_[t.y]), glm::distance(rest_[t.y], rest_[t.z]),
                                        glm::distance(rest_[t.z], rest_[t.x])});
                          return area(t, rest_) <= flat * longest * longest;
                      });
        areas_.resize(rest_.size());
        for (const glm::uvec3& t : triangles_)
            for (int corner = 0; corner < 3; ++corner)
            {
                areas_[t[corner]] += area(t, rest_) / 3;
                edges_[ordered(t[corner], t[(corner + 1) % 3])].push_back({t[(corner + 2) % 3], t});
            }
        take_material(mesh.material);
        for (size_t i = 0; i < rest_.size(); ++i)
            inverse_mass.push_back(areas_[i] > 0 ? 1 / (uniform_masses_ ? density_ : density_ * areas_[i]) : 0);
        for (size_t i = 0; i < mesh.inverse_masses.size(); ++i)
            inverse_mass[i] = areas_[i] > 0 ? double(mesh.inverse_masses[i]) : 0;
        for (const uint32_t held : mesh.pins)
            inverse_mass[held] = 0;
        for (size_t i = 0; i < rest_.size(); ++i)
            if (inverse_mass[i] == 0)
                state.v[i] = glm::dvec3(0);
    }

    [[nodiscard]] size_t size() const { return rest_.size(); }
    void step(double h, const Environment& environment) { rk4_step(*this, state, h, environment); }
    // `load`: of the solver's Stability for the step.
    void verlet_step(double h, uint32_t substeps, const Environment& environment, double load)
    {
        reference::verlet_step(*this, state, h, substeps, environment, load);
    }

    [[nodiscard]] std::vector<glm::dvec3> accelerations(const ClothState& s, const Environment& environment) const
    {
        std::vector<glm::dvec3> force(size(), glm::dvec3(0));
        for (const Spring& spring : springs)
        {
            const glm::dvec3 delta = s.x[spring.b] - s.x[spring.a];
            const glm::dvec3 d = glm::normalize(delta);
            const glm::dvec3 f = (spring.stiffness * (glm::length(delta) - spring.rest_length) +
                                  spring.damping * glm::dot(s.v[spring.b] - s.v[spring.a], d)) *
                                 d;
            force[spring.a] += f;
            force[spring.b] -= f;
        }
        for (const Thread& thread : threads)
        {
            const glm::dvec3 along = thread.sum(s.x);
            const glm::dvec3 d = glm::normalize(along);
            const double pull = thread.area * (thread.stiffness * (glm::length(along) - 1) +
                                               thread.damping * glm::dot(thread.sum(s.v), d));
            for (int i = 0; i < 3; ++i)
                force[thread.corner[i]] -= pull * thread.coefficient[i] * d;
        }
        for (const auto& [pair, q] : bending_form_) // minus the gradient of 1/2 B x^T Q x, and its damping
            force[pair.first] -= bending_ * q * (s.x[pair.second] + bending_time_ * s.v[pair.second]);
        for (const glm::uvec3& t : triangles_)
            for (int corner = 0; corner < 3; ++corner)
                force[t[corner]] += air(t, s, environment.wind - s.v[t[corner]], environment.air_density) / 3.0;
        for (size_t i = 0; i < size(); ++i)
        {
            force[i] += linear_drag_ * (environment.wind - s.v[i]);
            force[i] = inverse_mass[i] > 0 ? environment.gravity + inverse_mass[i] * force[i] : glm::dvec3(0);
        }
        return force;
    }

    [[nodiscard]] double energy(const Environment& environment) const // kinetic, elastic and potential, J
    {
        double total = 0;
        for (size_t i = 0; i < size(); ++i)
            if (inverse_mass[i] > 0)
                total += (0.5 * glm::dot(state.v[i], state.v[i]) - glm::dot(environment.gravity, state.x[i])) /
                         inverse_mass[i];
        for (const Spring& s : springs)
            total += 0.5 * s.stiffness * std::pow(glm::distance(state.x[s.a], state.x[s.b]) - s.rest_length, 2);
        for (const Thread& thread : threads)
            total += 0.5 * thread.area * thread.stiffness * std::pow(glm::length(thread.sum(state.x)) - 1, 2);
        for (const auto& [pair, q] : bending_form_)
            total += 0.5 * bending_ * q * glm::dot(state.x[pair.first], state.x[pair.second]);
        return total;
    }

    // Scales stiffness and bending, as the solver does for a substep that is too long.
    void soften(double stiffness)
    {
        for (Spring& spring : springs)
            spring.stiffness *= stiffness;
        bending_ *= stiffness;
    }

    // A bound of the frequency^2 of any vertex, 1/s^2: twice its springs and bending over its mass.
    [[nodiscard]] double omega_squared() const
    {
        std::vector<double> stiffness(size());
        for (const Spring& s : springs)
        {
            stiffness[s.a] += 2 * s.stiffness;
            stiffness[s.b] += 2 * s.stiffness;
        }
        for (size_t first = 0; first < threads.size(); first += 4) // the directions of a triangle
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                {
                    double pair = 0;
                    for (size_t k = first; k < first + 4; ++k)
                        pair += threads[k].area * threads[k].stiffness * threads[k].coefficient[i] *
                                threads[k].coefficient[j];
                    stiffness[threads[first].corner[i]] += std::abs(pair);
                }
        for (const auto& [pair, q] : bending_form_)
            stiffness[pair.first] += bending_ * std::abs(q);
        double largest = 0;
        for (size_t i = 0; i < size(); ++i)
            largest = std::max(largest, stiffness[i] * inverse_mass[i]);
        return largest;
    }

    // One direction of a triangle of fabric: a unit vector along it is mapped to the sum of coefficient * x.
    struct Thread
    {
        uint32_t corner[3];
        double coefficient[3]; // 1/m
        double area;           // m^2
        double stiffness;      // N/m
        double damping;        // N s/m

        [[nodiscard]] glm::dvec3 sum(const std::vector<glm::dvec3>& x) const
        {
            return coefficient[0] * x[corner[0]] + coefficient[1] * x[corner[1]] + coefficient[2] * x[corner[2]];
        }
    };

    ClothState state;
    std::vector<Spring> springs;
    std::vector<Thread> threads;
    std::vector<double> inverse_mass; // 1/kg

private:
    // The gradient, in the world, of the second coordinate of the mesh projected along its thinnest axis.
    void find_second_axis(const voile::MeshCloth& mesh)
    {
        glm::dvec3 low(1e300);
        glm::dvec3 high(-1e300);
        for (const glm::vec3& p : mesh.positions)
        {
            low = glm::min(low, glm::dvec3(p));
            high = glm::max(high, glm::dvec3(p));
        }
        const glm::dmat3 axes(mesh.transform);
        int thinnest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (glm::length(axes[axis]) * (high - low)[axis] < glm::length(axes[thinnest]) * (high - low)[thinnest])
                thinnest = axis;
        second_axis_ = glm::transpose(glm::inverse(axes))[thinnest == 2 ? 1 : 2];
    }

    void take_material(const voile::ClothMaterial& material)
    {
        if (const auto* raw = std::get_if<voile::Material>(&material))
        {
            density_ = double(raw->vertex_mass);
            uniform_masses_ = true;
            bending_ = double(raw->bending_stiffness);
            bending_time_ = double(raw->bending_time);
            linear_drag_ = double(raw->linear_drag);
            drag_normal_ = double(raw->air_drag_normal);
            drag_tangential_ = double(raw->air_drag_tangential);
            bending_form_ = bending_form(rest_, triangles_, edges_);
            const voile::Spring along = raw->springs.structural_warp;
            const voile::Spring across = raw->springs.bend_warp;
            for_each_edge(
                [&](uint32_t a, uint32_t b, double, double length) {
                    springs.push_back({a, b, double(along.stiffness), double(along.damping), length});
                });
            std::map<std::pair<uint32_t, uint32_t>, bool> seen; // one spring per pair, however many edges it crosses
            for_each_pair(
                [&](uint32_t a, uint32_t b, double, double length)
                {
                    if (!std::exchange(seen[ordered(a, b)], true))
                        springs.push_back({a, b, double(across.stiffness), double(across.damping), length});
                });
            return;
        }
        take_fabric(std::get<voile::Fabric>(material));
    }

    void take_fabric(const voile::Fabric& fabric)
    {
        density_ = double(fabric.areal_density);
        drag_normal_ = double(fabric.air_drag_normal);
        drag_tangential_ = double(fabric.air_drag_tangential);
        const double ratio = double(fabric.damping_ratio);
        const auto solid = double(std::count_if(areas_.begin(), areas_.end(), [](double a) { return a > 0; }));
        double mean_mass = 0;
        for (const double a : areas_)
            mean_mass += density_ * a / solid;
        add_membrane(fabric, mean_mass);
        if (fabric.bending_model == voile::BendingModel::springs)
        {
            const double stretch = 0.5 * (double(fabric.stretch_stiffness[0]) + double(fabric.stretch_stiffness[1]));
            const double time = 2 * ratio * std::sqrt(mean_mass / (2 * stretch)); // damping over stiffness
            for_each_pair(
                [&](uint32_t a, uint32_t b, double around, double length)
                {
                    const double stiffness = double(fabric.bending_stiffness) * 2 / 3 / around;
                    springs.push_back({a, b, stiffness, stiffness * time, length});
                });
            return;
        }
        bending_ = double(fabric.bending_stiffness);
        bending_form_ = bending_form(rest_, triangles_, edges_);
        std::vector<double> row_sums(size());
        for (const auto& [pair, q] : bending_form_)
            if (pair.first != pair.second)
                row_sums[pair.first] += std::abs(q);
        double fastest = 0;
        for (size_t i = 0; i < size(); ++i)
            if (areas_[i] > 0)
                fastest = std::max(fastest, 2 * bending_ * row_sums[i] / (density_ * areas_[i]));
        bending_time_ = fastest > 0 ? 2 * ratio / std::sqrt(fastest) : 0;
    }

    // Threads of a fabric whose warp and weft follow the axes of the mesh projected along its thinnest axis. The moduli
    // of stretch in one direction and of shear are the fabric's: (c_warp, K_s; K_s, c_weft) is the stiffness of strain
    // along both, and c_warp - K_s^2 / c_weft = K_warp, and the same for the weft. Diagonals at 45 degrees of 2 K_s
    // each have (K_s, K_s; K_s, K_s) and shear with K_s. Damping: the ratio to the critical damping of vertices of the
    // mean mass on a spring of a grid of square cells, whose diagonals have K_s.
    void add_membrane(const voile::Fabric& fabric, double mean_mass)
    {
        const double warp = double(fabric.stretch_stiffness[0]);
        const double weft = double(fabric.stretch_stiffness[1]);
        const double shear = double(fabric.shear_stiffness);
        const double quotient = weft / warp; // of the held stiffnesses, too
        const double held = warp / 2 * (1 + std::sqrt(1 + 4 * shear * shear / (warp * weft)));
        const auto damping = [&](double k)
        { return 2 * double(fabric.damping_ratio) * std::sqrt(std::max(k, 0.0) * mean_mass / 2); };
        for (const glm::uvec3& t : triangles_)
        {
            const auto [u, v] = fabric_axes(t);
            const struct
            {
                glm::dvec3 direction;
                double stiffness;
                double damping;
            } directions[] = {{u, held - shear, damping(held - shear)},
                              {v, quotient * held - shear, damping(quotient * held - shear)},
                              {glm::normalize(u + v), 2 * shear, 2 * damping(shear)},
                              {glm::normalize(u - v), 2 * shear, 2 * damping(shear)}};
            for (const auto& [direction, stiffness, loss] : directions)
            {
                Thread thread{{t.x, t.y, t.z}, {}, area(t, rest_), std::max(stiffness, 0.0), loss};
                for (int i = 0; i < 3; ++i)
                {
                    const glm::dvec3 up = height(rest_, t[(i + 1) % 3], t[(i + 2) % 3], t[i]);
                    thread.coefficient[i] = glm::dot(up, direction) / glm::dot(up, up);
                }
                threads.push_back(thread);
            }
        }
    }

    // Unit vectors of warp and weft in a triangle. The second of the mesh's own coordinates is constant along the warp.
    [[nodiscard]] std::pair<glm::dvec3, glm::dvec3> fabric_axes(const glm::uvec3& t) const
    {
        const glm::dvec3 normal = glm::normalize(glm::cross(rest_[t.y] - rest_[t.x], rest_[t.z] - rest_[t.x]));
        glm::dvec3 u = glm::cross(normal, second_axis_);
        u = glm::normalize(u);
        return {u, glm::cross(normal, u)};
    }

    // visit(a, b, area of the triangles around, length) of every edge.
    template <typename Visit>
    void for_each_edge(Visit visit) const
    {
        for (const auto& [edge, sides] : edges_)
        {
            double around = 0;
            for (const MeshSide& side : sides)
                around += area(side.triangle, rest_);
            visit(edge.first, edge.second, around, glm::distance(rest_[edge.first], rest_[edge.second]));
        }
    }

    // The same for every pair of vertices opposite to an edge.
    template <typename Visit>
    void for_each_pair(Visit visit) const
    {
        for (const auto& [edge, sides] : edges_)
            for (size_t i = 0; i < sides.size(); ++i)
                for (size_t j = i + 1; j < sides.size(); ++j)
                    if (sides[i].opposite != sides[j].opposite)
                        visit(sides[i].opposite, sides[j].opposite,
                              area(sides[i].triangle, rest_) + area(sides[j].triangle, rest_),
                              glm::distance(rest_[sides[i].opposite], rest_[sides[j].opposite]));
    }

    // Drag on a whole triangle whose velocity relative to the air is -u.
    [[nodiscard]] glm::dvec3 air(const glm::uvec3& t, const ClothState& s, const glm::dvec3& u, double density) const
    {
        const glm::dvec3 across = glm::cross(s.x[t.y] - s.x[t.x], s.x[t.z] - s.x[t.x]);
        if (drag_normal_ + drag_tangential_ == 0 || glm::length(across) == 0)
            return glm::dvec3(0);
        const glm::dvec3 n = glm::normalize(across);
        const glm::dvec3 normal = glm::dot(u, n) * n;
        const glm::dvec3 tangential = u - normal;
        return 0.5 * density * area(t, s.x) *
               (drag_normal_ * glm::length(normal) * normal + drag_tangential_ * glm::length(tangential) * tangential);
    }

    std::vector<glm::uvec3> triangles_; // that have area
    std::vector<glm::dvec3> rest_;
    glm::dvec3 second_axis_{0};
    std::vector<double> areas_; // m^2, of each vertex
    MeshEdges edges_;
    QuadraticForm bending_form_; // 1/m^2
    double density_ = 0;         // kg/m^2, or kg per vertex
    bool uniform_masses_ = false;
    double bending_ = 0; // N m
    double bending_time_ = 0;
    double linear_drag_ = 0;
    double drag_normal_ = 0;
    double drag_tangential_ = 0;
};

} // namespace reference
