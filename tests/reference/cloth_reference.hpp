// The cloth model in double precision on the CPU: springs, drag, gravity and RK4 by the textbook formulas. It does not
// follow the structure of the kernels: one loop over springs adds to both ends.
#pragma once

#include "integrators.hpp"

#include "voile/descriptions.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace reference
{

struct Spring
{
    uint32_t a;
    uint32_t b;
    double stiffness;
    double damping;
    double rest_length;
};

class Cloth
{
public:
    explicit Cloth(const voile::GridCloth& grid)
        : grid_(grid), material_(std::get<voile::Material>(grid.material)),
          inverse_mass_(size(), 1 / double(material_.vertex_mass))
    {
        const double du = double(grid.width) / (grid.columns - 1);
        const double dv = double(grid.depth) / (grid.rows - 1);
        for (uint32_t row = 0; row < grid.rows; ++row)
            for (uint32_t column = 0; column < grid.columns; ++column)
            {
                const double u = double(column) / (grid.columns - 1) - 0.5;
                const double v = double(row) / (grid.rows - 1) - 0.5;
                state.x.emplace_back(glm::dmat4(grid.transform) *
                                     glm::dvec4(u * double(grid.width), 0, v * double(grid.depth), 1));
                state.v.emplace_back(grid.velocity);
            }
        for (uint32_t i = 0; i < size(); ++i)
            inverse_mass_[i] /= border(i / grid.columns, grid.rows) * border(i % grid.columns, grid.columns);
        for (const uint32_t held : grid.pins)
        {
            inverse_mass_[held] = 0;
            state.v[held] = glm::dvec3(0);
        }
        const voile::SpringSet& s = material_.springs;
        const double diagonal = std::hypot(du, dv);
        add_family(1, 0, s.structural_warp, du);
        add_family(0, 1, s.structural_weft, dv);
        add_family(1, 1, s.shear, diagonal);
        add_family(-1, 1, s.shear, diagonal);
        add_family(2, 0, s.bend_warp, 2 * du);
        add_family(0, 2, s.bend_weft, 2 * dv);
        add_family(2, 2, s.diagonal_bend, 2 * diagonal);
        add_family(-2, 2, s.diagonal_bend, 2 * diagonal);
    }

    [[nodiscard]] size_t size() const { return size_t{grid_.columns} * grid_.rows; }

    [[nodiscard]] std::vector<glm::dvec3> accelerations(const ClothState& s, const Environment& environment) const
    {
        std::vector<glm::dvec3> force(size());
        for (size_t i = 0; i < size(); ++i)
            force[i] = double(material_.linear_drag) * (environment.wind - s.v[i]) + air_force(s, i, environment);
        for (const Spring& spring : springs)
        {
            const glm::dvec3 delta = s.x[spring.b] - s.x[spring.a];
            const double length = glm::length(delta);
            const glm::dvec3 d = delta / length;
            const glm::dvec3 f = (spring.stiffness * (length - spring.rest_length) +
                                  spring.damping * glm::dot(s.v[spring.b] - s.v[spring.a], d)) *
                                 d;
            force[spring.a] += f;
            force[spring.b] -= f;
        }
        std::vector<glm::dvec3> result(size(), glm::dvec3(0));
        for (size_t i = 0; i < size(); ++i)
            if (inverse_mass_[i] > 0)
                result[i] = environment.gravity + inverse_mass_[i] * force[i];
        return result;
    }

    void step(double h, const Environment& environment) { rk4_step(*this, state, h, environment); }

    // Velocity Verlet, `substeps` of h seconds each.
    // `load`: of the solver's Stability for the step.
    void verlet_step(double h, uint32_t substeps, const Environment& environment, double load)
    {
        reference::verlet_step(*this, state, h, substeps, environment, load);
    }

    [[nodiscard]] double energy(const Environment& environment) const // kinetic, elastic and potential, J
    {
        double total = 0;
        for (size_t i = 0; i < size(); ++i)
            if (inverse_mass_[i] > 0)
                total += (0.5 * glm::dot(state.v[i], state.v[i]) - glm::dot(environment.gravity, state.x[i])) /
                         inverse_mass_[i];
        for (const Spring& spring : springs)
        {
            const double stretch = glm::length(state.x[spring.b] - state.x[spring.a]) - spring.rest_length;
            total += 0.5 * spring.stiffness * stretch * stretch;
        }
        return total;
    }

    ClothState state;
    std::vector<Spring> springs;

private:
    void add_family(int columns, int rows, const voile::Spring& spring, double rest_length)
    {
        for (int row = 0; row + rows < int(grid_.rows); ++row)
            for (int column = 0; column < int(grid_.columns); ++column)
            {
                const int other = column + columns;
                if (other < 0 || other >= int(grid_.columns))
                    continue;
                // Along a row a spring belongs to that row's strip, along a column to that column's.
                const double scale = rows == 0      ? border(uint32_t(row), grid_.rows)
                                     : columns == 0 ? border(uint32_t(column), grid_.columns)
                                                    : 1;
                springs.push_back({uint32_t(row) * grid_.columns + uint32_t(column),
                                   uint32_t(row + rows) * grid_.columns + uint32_t(other),
                                   scale * double(spring.stiffness), scale * double(spring.damping), rest_length});
            }
    }

    [[nodiscard]] double border(uint32_t i, uint32_t count) const
    {
        return i == 0 || i + 1 == count ? double(material_.border_scale) : 1;
    }

    // The vertex takes a quarter of each of the four cells around it: half of the triangle that two sides span.
    [[nodiscard]] glm::dvec3 air_force(const ClothState& s, size_t i, const Environment& environment) const
    {
        const double c_n = material_.air_drag_normal;
        const double c_t = material_.air_drag_tangential;
        const int row = int(i / grid_.columns);
        const int column = int(i % grid_.columns);
        const auto side = [&](int r, int c)
        {
            const bool exists = r >= 0 && c >= 0 && r < int(grid_.rows) && c < int(grid_.columns);
            return exists ? s.x[size_t(r) * grid_.columns + size_t(c)] - s.x[i] : glm::dvec3(0);
        };
        glm::dvec3 force(0);
        for (const int down : {-1, 1})
            for (const int right : {-1, 1})
            {
                const glm::dvec3 across = glm::cross(side(row + down, column), side(row, column + right));
                if (glm::length(across) == 0 || c_n + c_t == 0)
                    continue;
                const glm::dvec3 n = glm::normalize(across);
                const double area = glm::length(across) / 4;
                const glm::dvec3 u = environment.wind - s.v[i];
                const double u_n = glm::dot(u, n);
                const glm::dvec3 u_t = u - u_n * n;
                force += 0.5 * environment.air_density * area *
                         (c_n * std::abs(u_n) * u_n * n + c_t * glm::length(u_t) * u_t);
            }
        return force;
    }

    voile::GridCloth grid_;
    voile::Material material_;
    std::vector<double> inverse_mass_;
};

} // namespace reference
