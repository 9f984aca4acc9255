// Tuning that is refused, and how.
#include "support/cloth_harness.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>

namespace
{

std::string refused(const voile::Tuning& tuning)
{
    const auto solver = voile::Solver::create(tests::device().context().handles, {.tuning = tuning});
    return solver ? "accepted" : solver.error().message;
}

} // namespace

TEST_CASE("tuning outside of its range and invalid enumerators are refused")
{
    CHECK(refused({.contact_method = static_cast<voile::ContactMethod>(5)}) ==
          "Tuning: contact_method is 5, must be normal_ray or nearest_point");
    CHECK(refused({.mesh_layout = static_cast<voile::MeshLayout>(2)}) ==
          "Tuning: mesh_layout is 2, must be compact or interleaved");
    CHECK(refused({.feature_items = 129}) == "Tuning: feature_items is 129, must be at most 128");
    CHECK(refused({.contact_interval = std::numeric_limits<float>::infinity()}) ==
          "Tuning: contact_interval is inf s, must be at least 0 and finite");
    CHECK(refused({.contact_interval = -1}) ==
          "Tuning: contact_interval is -1.000000 s, must be at least 0 and finite");
}

TEST_CASE("threads per vertex are a power of two of at most the workgroup size")
{
    for (const uint32_t threads : {3u, 128u})
    {
        const std::string rule =
            " is " + std::to_string(threads) + ", must be 0 or a power of two up to workgroup_size";
        CHECK(refused({.workgroup_size = 64, .feature_threads = threads}) == "Tuning: feature_threads" + rule);
        CHECK(refused({.workgroup_size = 64, .listing_threads = threads}) == "Tuning: listing_threads" + rule);
    }
}
