// Whole numbers of up to 1024 bits: sums, differences and products are exact.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>

namespace tests
{

class Whole
{
public:
    Whole() = default;

    // x / 2^-149, which is a whole number for every finite float.
    explicit Whole(float x)
    {
        const auto bits = std::bit_cast<uint32_t>(x);
        const uint32_t exponent = (bits >> 23) & 0xff;
        const uint32_t mantissa = (bits & 0x7fffff) | (exponent > 0 ? 0x800000 : 0);
        const uint32_t shift = std::max(exponent, 1u) - 1;
        const uint64_t shifted = uint64_t{mantissa} << shift % 32;
        words_[shift / 32] = static_cast<uint32_t>(shifted);
        words_[shift / 32 + 1] = static_cast<uint32_t>(shifted >> 32);
        negative_ = bits >> 31 != 0;
        trim(shift / 32 + 2);
    }

    [[nodiscard]] int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

    friend Whole operator-(Whole a)
    {
        a.negative_ = !a.negative_;
        return a;
    }

    friend Whole operator+(const Whole& a, const Whole& b)
    {
        if (a.negative_ == b.negative_)
            return sum(a, b);
        return less(a, b) ? rest(b, a) : rest(a, b);
    }

    friend Whole operator-(const Whole& a, const Whole& b) { return a + -b; }

    friend Whole operator*(const Whole& a, const Whole& b)
    {
        Whole result;
        for (size_t i = 0; i < a.size_; ++i)
        {
            uint64_t carry = 0;
            for (size_t j = 0; j < b.size_; ++j)
            {
                carry += uint64_t{a.words_[i]} * b.words_[j] + result.word(i + j);
                result.word(i + j) = static_cast<uint32_t>(carry);
                carry >>= 32;
            }
            result.word(i + b.size_) = static_cast<uint32_t>(carry);
        }
        result.negative_ = a.negative_ != b.negative_;
        result.trim(a.size_ + b.size_);
        return result;
    }

    friend bool operator<(const Whole& a, const Whole& b) { return (a - b).sign() < 0; }

private:
    static constexpr size_t k_words = 32;

    uint32_t& word(size_t i)
    {
        if (i >= k_words)
            std::abort(); // no test needs so many
        return words_[i];
    }

    void trim(size_t size)
    {
        size_ = std::min(size, k_words);
        while (size_ > 0 && words_[size_ - 1] == 0)
            --size_;
    }

    // Of magnitudes.
    static bool less(const Whole& a, const Whole& b)
    {
        if (a.size_ != b.size_)
            return a.size_ < b.size_;
        return std::lexicographical_compare(a.words_.rend() - static_cast<std::ptrdiff_t>(a.size_), a.words_.rend(),
                                            b.words_.rend() - static_cast<std::ptrdiff_t>(b.size_), b.words_.rend());
    }

    static Whole sum(const Whole& a, const Whole& b)
    {
        Whole result;
        result.negative_ = a.negative_;
        const size_t size = std::max(a.size_, b.size_);
        uint64_t carry = 0;
        for (size_t i = 0; i < size; ++i)
        {
            carry += uint64_t{a.words_[i]} + b.words_[i];
            result.words_[i] = static_cast<uint32_t>(carry);
            carry >>= 32;
        }
        if (carry != 0)
            result.word(size) = 1;
        result.trim(size + 1);
        return result;
    }

    // Of the larger magnitude and the smaller one.
    static Whole rest(const Whole& large, const Whole& small)
    {
        Whole result;
        result.negative_ = large.negative_;
        int64_t borrow = 0;
        for (size_t i = 0; i < large.size_; ++i)
        {
            borrow += int64_t{large.words_[i]} - small.words_[i];
            result.words_[i] = static_cast<uint32_t>(borrow);
            borrow >>= 32;
        }
        result.trim(large.size_);
        return result;
    }

    std::array<uint32_t, k_words> words_{}; // the lowest one first
    size_t size_ = 0;                       // words up to the highest one that is not 0
    bool negative_ = false;
};

} // namespace tests
