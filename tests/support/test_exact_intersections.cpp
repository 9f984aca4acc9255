// Tests the exact reference against cases that are counted by hand, and its filter against whole numbers.
#include "support/exact_intersections.hpp"

#include <doctest/doctest.h>

#include <random>

namespace
{

using tests::EdgeEnds;
using tests::TriangleCorners;
using tests::Whole;

constexpr TriangleCorners k_triangle{glm::vec3(0, 0, 0), glm::vec3(4, 0, 0), glm::vec3(0, 0, 4)};

} // namespace

TEST_CASE("whole numbers are exact beyond the range of doubles")
{
    const Whole large(1e30f);
    const Whole tiny(1e-44f);
    CHECK((large + tiny - large - tiny).sign() == 0);
    CHECK(((large + tiny) * (large + tiny) - large * large).sign() == 1);
    CHECK(((large - tiny) * (large + tiny) - large * large + tiny * tiny).sign() == 0);
    CHECK((Whole(-3.f) * Whole(5.f) + Whole(15.f) * Whole(1.f)).sign() == 0);
    CHECK(Whole(-2.f) < Whole(-1.f));
    CHECK(!(Whole(0.f) < Whole(-0.f)));
}

TEST_CASE("an edge and a triangle intersect where they touch, and are apart by one bit")
{
    const float above = 1e-45f;
    CHECK(tests::intersect({glm::vec3(1, -1, 1), glm::vec3(1, 1, 1)}, k_triangle));
    CHECK(tests::intersect({glm::vec3(1, 0, 1), glm::vec3(1, 1, 1)}, k_triangle)); // an end in the face
    CHECK(!tests::intersect({glm::vec3(1, above, 1), glm::vec3(1, 1, 1)}, k_triangle));
    CHECK(tests::intersect({glm::vec3(2, -1, 2), glm::vec3(2, 1, 2)}, k_triangle)); // through a side
    CHECK(!tests::intersect({glm::vec3(2, -1, std::nextafter(2.f, 3.f)), glm::vec3(2, 1, 2)}, k_triangle) ==
          !tests::intersect_by_axes({glm::vec3(2, -1, std::nextafter(2.f, 3.f)), glm::vec3(2, 1, 2)}, k_triangle));
    CHECK(tests::intersect({glm::vec3(0, -1, 0), glm::vec3(0, 1, 0)}, k_triangle));   // through a corner
    CHECK(tests::intersect({glm::vec3(-1, 0, 1), glm::vec3(9, 0, 1)}, k_triangle));   // in the plane, across
    CHECK(tests::intersect({glm::vec3(1, 0, 1), glm::vec3(1.5f, 0, 1)}, k_triangle)); // in the plane, inside
    CHECK(tests::intersect({glm::vec3(4, 0, 0), glm::vec3(9, 0, 0)}, k_triangle));    // on the line of a side
    CHECK(!tests::intersect({glm::vec3(std::nextafter(4.f, 5.f), 0, 0), glm::vec3(9, 0, 0)}, k_triangle));
    CHECK(!tests::intersect({glm::vec3(3, 0, 3), glm::vec3(9, 0, 3)}, k_triangle)); // in the plane, beside
}

TEST_CASE("triangles without an area and edges without a length are points and segments")
{
    const TriangleCorners line{glm::vec3(0), glm::vec3(1, 1, 1), glm::vec3(3, 3, 3)};
    const TriangleCorners point{glm::vec3(2), glm::vec3(2), glm::vec3(2)};
    CHECK(tests::intersect({glm::vec3(2, 0, 2), glm::vec3(2, 4, 2)}, line));
    CHECK(!tests::intersect({glm::vec3(2, 0, 2.5f), glm::vec3(2, 4, 2.5f)}, line)); // skew
    CHECK(!tests::intersect({glm::vec3(0, 0.5f, 0), glm::vec3(2, 2.5f, 2)}, line)); // parallel
    CHECK(tests::intersect({glm::vec3(3), glm::vec3(5)}, line));
    CHECK(!tests::intersect({glm::vec3(4), glm::vec3(5)}, line));
    CHECK(tests::intersect({glm::vec3(2), glm::vec3(2)}, line));
    CHECK(!tests::intersect({glm::vec3(2, 2, 1), glm::vec3(2, 2, 1)}, line));
    CHECK(tests::intersect({glm::vec3(1), glm::vec3(3)}, point));
    CHECK(!tests::intersect({glm::vec3(1, 1, 2), glm::vec3(3, 3, 2.5f)}, point));
}

TEST_CASE("the filter of the exact reference never contradicts whole numbers")
{
    std::mt19937 random(3);
    uint32_t decided = 0;
    uint32_t hits = 0;
    for (int i = 0; i < 20000; ++i)
    {
        // Small whole numbers make many degenerate cases.
        std::uniform_int_distribution<int> coordinate(0, i % 2 == 0 ? 2 : 5);
        const auto point = [&]
        {
            const auto x = static_cast<float>(coordinate(random));
            const auto y = static_cast<float>(coordinate(random));
            return glm::vec3(x, y, static_cast<float>(coordinate(random)));
        };
        const EdgeEnds e{point(), point()};
        const TriangleCorners t{point(), point(), point()};
        const bool exact = tests::intersect_by_axes(e, t);
        hits += exact ? 1 : 0;
        if (const auto certain = tests::intersect_by_signs(e, t))
        {
            ++decided;
            REQUIRE(*certain == exact);
        }
        REQUIRE(tests::intersect_by_axes({e[1], e[0]}, {t[2], t[0], t[1]}) == exact);
    }
    CHECK(decided > 5000);
    CHECK(hits > 2000);
}
