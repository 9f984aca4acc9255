#include "geometry/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace voile
{

namespace
{

// A sum of doubles without rounding: its terms do not overlap, and the last one that is not 0 has its sign.
class ExactSum
{
public:
    void add(double value)
    {
        for (size_t i = 0; i < count_; ++i)
        {
            const double sum = value + terms_[i];
            const double part = sum - value;
            terms_[i] = (value - (sum - part)) + (terms_[i] - part);
            value = sum;
        }
        terms_[count_++] = value;
    }

    [[nodiscard]] int sign() const
    {
        for (size_t i = count_; i-- > 0;)
            if (terms_[i] != 0)
                return terms_[i] > 0 ? 1 : -1;
        return 0;
    }

private:
    std::array<double, 48> terms_; // two for each product of a determinant of four points
    size_t count_ = 0;
};

// The products of two floats are exact in double. The third factor leaves a rest.
void add_product(ExactSum& sum, float x, float y, float z, double factor)
{
    const double both = factor * x * y;
    const double product = both * z;
    sum.add(std::fma(both, static_cast<double>(z), -product));
    sum.add(product);
}

// factor * dot(cross(a, b), c)
void add_volume(ExactSum& sum, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, double factor)
{
    for (int x = 0; x < 3; ++x)
    {
        const int y = (x + 1) % 3;
        const int z = (x + 2) % 3;
        add_product(sum, a[y], b[z], c[x], factor);
        add_product(sum, a[z], b[y], c[x], -factor);
    }
}

} // namespace

int orientation(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d)
{
    const glm::dvec3 u = glm::dvec3(a) - glm::dvec3(d);
    const glm::dvec3 v = glm::dvec3(b) - glm::dvec3(d);
    const glm::dvec3 w = glm::dvec3(c) - glm::dvec3(d);
    const glm::dvec3 left(u.y * v.z, u.z * v.x, u.x * v.y);
    const glm::dvec3 right(u.z * v.y, u.x * v.z, u.y * v.x);
    const double volume = glm::dot(left - right, w);
    // Rounding changes the volume by less than 9 * 2^-53 of this.
    const double size = glm::dot(glm::abs(left) + glm::abs(right), glm::abs(w));
    constexpr double k_error = 2e-15;
    if (std::abs(volume) > k_error * size)
        return volume > 0 ? 1 : -1;

    ExactSum sum;
    add_volume(sum, a, b, c, 1);
    add_volume(sum, b, c, d, -1);
    add_volume(sum, c, d, a, 1);
    add_volume(sum, d, a, b, -1);
    return sum.sign();
}

} // namespace voile
