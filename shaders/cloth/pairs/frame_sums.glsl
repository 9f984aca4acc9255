// Sums over the vertices of a cloth or an island (FrameSums), and how fast it moves and turns on average.
#ifndef VOILE_FRAME_SUMS_GLSL
#define VOILE_FRAME_SUMS_GLSL

#include "pairs/rigid_motion.glsl"

// The largest high word of a workgroup's sum, as a multiple of their number: all sums are numbers.
const float k_most_high = 2e9;

// The least moment of inertia about any axis, as a part of the trace.
const float k_least_inertia = 1e-5;

FrameSums no_frame_sums()
{
    FrameSums sums;
    sums.restrained = 0;
    for (uint k = 0; k < VOILE_FRAME_SUMS; ++k)
    {
        sums.low[k] = 0;
        sums.high[k] = 0;
    }
    return sums;
}

float frame_unit(uint sum)
{
    if (sum < VOILE_FRAME_MIXED)
        return VOILE_FRAME_UNIT_DIRECTION;
    if (sum < VOILE_FRAME_DRIVES)
        return VOILE_FRAME_UNIT_LEVER;
    if (sum < VOILE_FRAME_SQUARES)
        return VOILE_FRAME_UNIT_DRIVE;
    return sum == VOILE_FRAME_SQUARES ? VOILE_FRAME_UNIT_SQUARE : VOILE_FRAME_UNIT_MOTION;
}

// The words of one of `groups` numbers that are added up: the lower one, and the upper one.
ivec2 frame_words(float sum, uint k, uint groups)
{
    const float units = round(sum / frame_unit(k));
    const float most = floor(k_most_high / float(groups));
    const float high = clamp(floor(units / 65536), -most, most);
    return ivec2(int(clamp(units - 65536 * high, 0, 65535)), int(high));
}

float frame_sum(uint low, int high, uint k) { return (65536.0 * float(high) + float(low)) * frame_unit(k); }

float[VOILE_FRAME_SUMS] sums_of(FrameSums words)
{
    float sums[VOILE_FRAME_SUMS];
    for (uint k = 0; k < VOILE_FRAME_SUMS; ++k)
        sums[k] = frame_sum(words.low[k], words.high[k], k);
    return sums;
}

mat3 symmetric(vec3 diagonal, vec3 beside)
{
    return mat3(diagonal.x, beside.z, beside.y, beside.z, diagonal.y, beside.x, beside.y, beside.x, diagonal.z);
}

vec3 diagonal_of(mat3 m) { return vec3(m[0][0], m[1][1], m[2][2]); }

vec3 beside_of(mat3 m) { return vec3(m[1][2], m[2][0], m[0][1]); }

float trace(mat3 m) { return m[0][0] + m[1][1] + m[2][2]; }

vec3 sums_from(float sums[VOILE_FRAME_SUMS], uint first) { return vec3(sums[first], sums[first + 1], sums[first + 2]); }

mat3 symmetric_from(float sums[VOILE_FRAME_SUMS], uint first)
{
    return symmetric(sums_from(sums, first), sums_from(sums, first + 3));
}

mat3 matrix_from(float sums[VOILE_FRAME_SUMS], uint first)
{
    return mat3(sums_from(sums, first), sums_from(sums, first + 3), sums_from(sums, first + 6));
}

// times v: cross(a, v)
mat3 cross_matrix(vec3 a) { return mat3(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0); }

// Per unit of mass, of what has the mean square `spread` of positions.
mat3 inertia_of(mat3 spread) { return trace(spread) * mat3(1) - spread; }

// How the vertices move: means.
struct MeanMotion
{
    vec3 velocity; // m/s
    vec3 position; // m, from the origin
    vec3 spin;     // m^2/s: r x v
    mat3 spread;   // m^2: r r^T
};

// The motion of a rigid body with the same momentum and angular momentum.
RigidMotion rigid_motion(MeanMotion of)
{
    const mat3 spread = of.spread - outerProduct(of.position, of.position);
    const float least = k_least_inertia * trace(spread) + 1e-20; // of a straight line
    const vec3 spin = of.spin - cross(of.position, of.velocity);
    const vec3 w = inverse(inertia_of(spread) + least * mat3(1)) * spin;
    return RigidMotion(of.velocity - cross(w, of.position), w);
}

// m^2/s^2: the mean square of the speed of vertices that move so.
float mean_square(MeanMotion of, RigidMotion motion)
{
    const vec3 w = motion.angular_velocity;
    return dot(motion.velocity, motion.velocity) + 2 * dot(motion.velocity, cross(w, of.position)) +
           dot(w, inertia_of(of.spread) * w);
}

#endif
