// The report card's cases at their coarser resolution. docs/physics.md has both, and is written by physics_report.
#include "physics/cases.hpp"

#include <doctest/doctest.h>

namespace
{

// Within the report's own targets, or within `bound` where the coarser resolution needs more.
void check(const physics::CaseResult& result, double bound = 0)
{
    CHECK_FALSE(result.measurements.empty());
    for (physics::Measurement m : result.measurements)
    {
        CAPTURE(m.quantity);
        CAPTURE(m.value);
        CAPTURE(m.exact);
        if (bound > 0)
            m.target = bound;
        CHECK(m.good());
    }
}

} // namespace

TEST_CASE("free fall does not feel internal damping, with either integrator")
{
    check(physics::free_fall(physics::Detail::coarse));
}

TEST_CASE("RK4 is of fourth order, velocity Verlet of second")
{
    check(physics::order(physics::Detail::coarse));
}

TEST_CASE("the period of a spring pair, with either integrator")
{
    check(physics::spring_pair(physics::Detail::coarse));
}

TEST_CASE("an undamped free cloth keeps its energy for ten seconds")
{
    // The target holds at the report's finer step. Here the step is twice as long: 4 times the departure for an
    // integrator of second order.
    check(physics::energy(physics::Detail::coarse), 4 * 1e-3);
}

TEST_CASE("a hanging sheet stretches by rho g L / 2 k at three resolutions")
{
    check(physics::hanging_sheet(physics::Detail::coarse));
}

TEST_CASE("a strip between two holds hangs in a catenary at four spans")
{
    check(physics::catenary(physics::Detail::coarse));
}

TEST_CASE("a hanging strip swings with a chain's two first periods")
{
    check(physics::hanging_chain(physics::Detail::coarse));
}

TEST_CASE("a falling plate reaches its terminal speed all over")
{
    check(physics::terminal_speed(physics::Detail::coarse));
}

TEST_CASE("a cantilever of a grid follows the heavy elastica")
{
    check(physics::cantilever_grid(physics::Detail::coarse));
}

TEST_CASE("a cantilever of triangles follows the heavy elastica")
{
    check(physics::cantilever_mesh(physics::Detail::coarse));
}

TEST_CASE("a patch sticks to an incline or slides down it, on a plane and on triangles")
{
    check(physics::incline(physics::Detail::coarse));
}

TEST_CASE("a strap around a cylinder has tensions in the ratio exp(mu phi)")
{
    check(physics::strap(physics::Detail::coarse));
}

TEST_CASE("discs of the presets drape by their published coefficients")
{
    check(physics::drape(physics::Detail::coarse));
}
