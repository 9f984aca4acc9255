// Cloth with fewer substeps than it needs is softened and never gains energy.
#include "support/shots.hpp"

namespace
{

using tests::edge_of_a_box;
using tests::shoot;
using tests::Shot;

constexpr float k_thick = 0.003f; // m, cotton's

} // namespace

// Velocity Verlet with 20 substeps of the 73 that cotton needs, stretched to four times its length, and with few or
// most of them.
TEST_CASE("softened cloth gains no energy when it is shot at an edge")
{
    for (const uint32_t substeps : {10u, 20u, 56u})
        (void)shoot(edge_of_a_box(false), {48, 1.5f, 60, k_thick, 6, 0, 1, substeps});
}

TEST_CASE("softened cloth with a strain limit gains no energy when it is shot at an edge")
{
    for (const uint32_t substeps : {5u, 10u, 20u})
        (void)shoot(edge_of_a_box(false), {.vertices = 48,
                                           .size = 1.5f,
                                           .speed = 60,
                                           .thickness = k_thick,
                                           .frames = 6,
                                           .stiffness = 1,
                                           .substeps = substeps,
                                           .strain_limit = 0.1f});
}

// Silk in 20 of its 116 substeps, and cloth without damping of its own in 20 of 68.
TEST_CASE("softened silk and softened undamped cloth gain no energy when they are shot at an edge")
{
    Shot shot{
        .vertices = 38, .size = 0.79f, .speed = 40, .thickness = 0.002f, .frames = 8, .stiffness = 1, .substeps = 20};
    shot.fabric = voile::silk();
    (void)shoot(edge_of_a_box(false), shot);
    shot.strain_limit = 0.1f;
    shot.speed = 46; // at 40 m/s edges are in the box for some frames (docs/contact.md)
    (void)shoot(edge_of_a_box(false), shot);
    shot = {
        .vertices = 48, .size = 1.5f, .speed = 60, .thickness = k_thick, .frames = 6, .stiffness = 1, .substeps = 20};
    shot.fabric.damping_ratio = 0;
    (void)shoot(edge_of_a_box(false), shot);
}
