// Exact signs of orientation determinants of positions in float.
//
// A filter in float decides most of them. Where its error bound does not exclude 0, integers decide: along each axis
// the coordinates are multiples of a power of two. A determinant has one factor of each axis in every product, so each
// axis may have a power of its own. Differences of coordinates then have up to 64 bits, and the determinant fits 7
// words. If the coordinates of an axis need more bits than that, the sign is k_uncertain. Multiples of 2^-50 m (snapped)
// up to 2^11 m do not.
//
// Error bounds hold for any order of evaluation and for rounding to nearest or toward zero, eps = 2^-23. A difference
// is exact to (1 + eps), a 2 x 2 minor to (1 + eps)^4 of the sum of its absolute products, a product with the third
// factor to (1 + eps)^6, the sum of three to (1 + eps)^8. So the error of the volume is below 8.1 eps times the sum of
// absolute products; computed in float, that sum is at least (1 - eps)^8 of the exact one. Values below 2^-126 may be
// flushed to 0, which changes a volume by less than 2^-74 if coordinates are below 2^21 m.
#ifndef VOILE_ORIENTATION_GLSL
#define VOILE_ORIENTATION_GLSL

const int k_uncertain = -2; // of a sign, beside -1, 0 and 1: two bits

const float k_volume_error = 9.0 / 8388608; // of the sum of absolute products
const float k_volume_flushed = 5.3e-23;     // m^3, 2^-74

// An integer of 64 bits, low word first, and its sign.
struct Integer
{
    uvec2 magnitude;
    bool negative;
};

const int k_no_bit = 1000;    // of a 0
const int k_most_bits = 62;   // from the lowest bit to the highest one, so that differences have 64 bits
const int k_volume_words = 7; // 6 products of 192 bits

const float k_unit = 1.0 / 1125899906842624.0; // m, 2^-50

// Multiples of the unit. What is above 2^-26 m is one in float.
vec3 snapped(vec3 p)
{
    precise const vec3 multiple = k_unit * roundEven(p / k_unit);
    return mix(p, multiple, lessThan(abs(p), vec3(1.0 / 67108864.0)));
}

uint float_exponent(float x) { return max((floatBitsToUint(x) >> 23) & 0xffu, 1u); }

uint float_mantissa(float x)
{
    const uint bits = floatBitsToUint(x);
    return (bits & 0x7fffffu) | ((bits & 0x7f800000u) != 0 ? 0x800000u : 0u);
}

// The exponents of the lowest and the highest bit that is set, counted from the same power of two.
int lowest_bit(float x)
{
    const uint mantissa = float_mantissa(x);
    return mantissa == 0 ? k_no_bit : int(float_exponent(x)) + findLSB(mantissa);
}

int highest_bit(float x)
{
    const uint mantissa = float_mantissa(x);
    return mantissa == 0 ? -k_no_bit : int(float_exponent(x)) + findMSB(mantissa);
}

ivec3 lowest_bits(vec3 p) { return ivec3(lowest_bit(p.x), lowest_bit(p.y), lowest_bit(p.z)); }
ivec3 highest_bits(vec3 p) { return ivec3(highest_bit(p.x), highest_bit(p.y), highest_bit(p.z)); }

// x in units of the bit `unit`, which is not above its lowest one.
Integer to_integer(float x, int unit)
{
    const uint mantissa = float_mantissa(x);
    const int shift = int(float_exponent(x)) - unit;
    Integer result;
    result.negative = floatBitsToUint(x) >> 31 != 0;
    if (mantissa == 0 || shift <= 0)
        result.magnitude = uvec2(mantissa == 0 ? 0 : mantissa >> -shift, 0);
    else if (shift >= 32)
        result.magnitude = uvec2(0, mantissa << (shift - 32));
    else
        result.magnitude = uvec2(mantissa << shift, mantissa >> (32 - shift));
    return result;
}

// Below 2^64 in magnitude if both are below 2^63.
Integer difference(Integer a, Integer b)
{
    Integer result;
    result.negative = a.negative;
    uint carry;
    if (a.negative != b.negative)
    {
        result.magnitude.x = uaddCarry(a.magnitude.x, b.magnitude.x, carry);
        result.magnitude.y = a.magnitude.y + b.magnitude.y + carry;
        return result;
    }
    const bool less = a.magnitude.y != b.magnitude.y ? a.magnitude.y < b.magnitude.y : a.magnitude.x < b.magnitude.x;
    const uvec2 large = less ? b.magnitude : a.magnitude;
    const uvec2 small = less ? a.magnitude : b.magnitude;
    result.magnitude.x = usubBorrow(large.x, small.x, carry);
    result.magnitude.y = large.y - small.y - carry;
    result.negative = a.negative != less;
    return result;
}

// words[first ...] += factor * number, for a number of four words. Carries end in the word after them.
void add_row(inout uint words[k_volume_words], uint first, uvec4 number, uint factor)
{
    uint carry = 0;
    for (uint i = 0; i < 4; ++i)
    {
        uint high;
        uint low;
        uint over_a;
        uint over_b;
        umulExtended(number[i], factor, high, low);
        low = uaddCarry(low, words[first + i], over_a);
        low = uaddCarry(low, carry, over_b);
        words[first + i] = low;
        carry = high + over_a + over_b;
    }
    words[first + 4] = carry; // was 0
}

// sum += x * y * z, or -= with `subtract`; the sum is in two's complement.
void add_product(inout uint sum[k_volume_words], Integer x, Integer y, Integer z, bool subtract)
{
    uint square[k_volume_words] = uint[](0, 0, 0, 0, 0, 0, 0);
    add_row(square, 0, uvec4(x.magnitude, 0, 0), y.magnitude.x);
    square[4] = 0;
    add_row(square, 1, uvec4(x.magnitude, 0, 0), y.magnitude.y);
    const uvec4 area = uvec4(square[0], square[1], square[2], square[3]);
    uint volume[k_volume_words] = uint[](0, 0, 0, 0, 0, 0, 0);
    add_row(volume, 0, area, z.magnitude.x);
    add_row(volume, 1, area, z.magnitude.y);
    const bool negative = ((x.negative != y.negative) != z.negative) != subtract;
    uint carry = 0;
    for (uint i = 0; i < k_volume_words; ++i)
    {
        uint over_a;
        uint over_b;
        if (negative)
        {
            sum[i] = usubBorrow(sum[i], volume[i], over_a);
            sum[i] = usubBorrow(sum[i], carry, over_b);
        }
        else
        {
            sum[i] = uaddCarry(sum[i], volume[i], over_a);
            sum[i] = uaddCarry(sum[i], carry, over_b);
        }
        carry = over_a + over_b;
    }
}

int sign_of(uint sum[k_volume_words])
{
    uint any_bit = 0;
    for (uint i = 0; i < k_volume_words; ++i)
        any_bit |= sum[i];
    return any_bit == 0 ? 0 : (sum[k_volume_words - 1] >> 31 != 0 ? -1 : 1);
}

struct IntegerRow
{
    Integer x;
    Integer y;
    Integer z;
};

IntegerRow row_between(vec3 p, vec3 origin, ivec3 unit)
{
    return IntegerRow(difference(to_integer(p.x, unit.x), to_integer(origin.x, unit.x)),
                      difference(to_integer(p.y, unit.y), to_integer(origin.y, unit.y)),
                      difference(to_integer(p.z, unit.z), to_integer(origin.z, unit.z)));
}

int exact_orientation(vec3 a, vec3 b, vec3 c, vec3 d)
{
    const ivec3 unit = min(min(lowest_bits(a), lowest_bits(b)), min(lowest_bits(c), lowest_bits(d)));
    const ivec3 high = max(max(highest_bits(a), highest_bits(b)), max(highest_bits(c), highest_bits(d)));
    if (any(greaterThan(high - unit, ivec3(k_most_bits))))
        return k_uncertain;
    IntegerRow first = row_between(a, d, unit);
    IntegerRow second = row_between(b, d, unit);
    IntegerRow third = row_between(c, d, unit);
    uint sum[k_volume_words] = uint[](0, 0, 0, 0, 0, 0, 0);
    for (uint turn = 0; turn < 3; ++turn)
    {
        add_product(sum, first.x, second.y, third.z, false);
        add_product(sum, first.x, second.z, third.y, true);
        const IntegerRow before = first;
        first = second;
        second = third;
        third = before;
    }
    return sign_of(sum);
}

// The sign of the volume (a - d, b - d, c - d).
int orientation(vec3 a, vec3 b, vec3 c, vec3 d)
{
    precise const vec3 ad = a - d;
    precise const vec3 bd = b - d;
    precise const vec3 cd = c - d;
    precise const vec3 left = bd.yzx * cd.zxy;
    precise const vec3 right = bd.zxy * cd.yzx;
    precise const vec3 terms = ad * (left - right);
    precise const vec3 sizes = abs(ad) * (abs(left) + abs(right));
    precise const float volume = terms.x + terms.y + terms.z;
    precise const float bound = k_volume_error * (sizes.x + sizes.y + sizes.z) + k_volume_flushed;
    if (abs(volume) > bound)
        return volume > 0 ? 1 : -1;
    return exact_orientation(a, b, c, d);
}

#endif
