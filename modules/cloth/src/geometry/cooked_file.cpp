// Cooked data: the header and its checks, which come before all others.
#include "geometry/cooked_file.hpp"

#include "geometry/content_hash.hpp"
#include "geometry/parallel.hpp"

#include <array>
#include <cstdint>

namespace voile
{

namespace
{

constexpr std::array<char, 8> k_magic{'v', 'o', 'i', 'l', 'e', ' ', 'c', '\n'};
constexpr uint32_t k_byte_order = 0x01020304;

struct Header
{
    std::array<char, 8> magic;
    uint32_t version;
    uint32_t byte_order; // k_byte_order as the machine that cooked wrote it: little-endian
    CookedKind kind;
    uint32_t padding;
    uint64_t bytes;    // with the header
    uint64_t checksum; // of everything after the header, and of the members before
    uint64_t padding_1;
};
static_assert(sizeof(Header) == 48 && sizeof(Header) % k_cooked_alignment == 0);

// Pieces are hashed on all cores; where they begin does not depend on their number.
uint64_t checksum_of(std::span<const std::byte> bytes)
{
    constexpr size_t k_piece = size_t{1} << 20;
    Header header{};
    std::memcpy(&header, bytes.data(), sizeof(header));
    header.checksum = 0;
    const std::span<const std::byte> body = bytes.subspan(sizeof(Header));
    std::vector<ContentHash> hashes(body.size() / k_piece + 1);
    parallel_for(body.size(), k_piece,
                 [&](size_t first, size_t last)
                 { hashes[first / k_piece] = hash_bytes(body.subspan(first, last - first)); });
    return hash_bytes(std::as_bytes(std::span(hashes)), hash_bytes(std::as_bytes(std::span(&header, 1)))).low;
}

} // namespace

CookedWriter::CookedWriter(CookedKind kind)
{
    const Header header{k_magic, k_cooked_version, k_byte_order, kind, 0, 0, 0, 0};
    add(header);
}

std::vector<std::byte> CookedWriter::finish()
{
    sign_cooked(bytes_);
    return std::move(bytes_);
}

void sign_cooked(std::span<std::byte> bytes)
{
    Header header{};
    std::memcpy(&header, bytes.data(), sizeof(header));
    header.bytes = bytes.size();
    std::memcpy(bytes.data(), &header, sizeof(header));
    header.checksum = checksum_of(bytes);
    std::memcpy(bytes.data(), &header, sizeof(header));
}

CookedReader::CookedReader(std::span<const std::byte> bytes) : bytes_(bytes), next_(sizeof(Header)) {}

Result<CookedReader> CookedReader::open(std::span<const std::byte> bytes, CookedKind kind)
{
    const auto bad = [](const std::string& reason) { return Error{"cooked data: " + reason}; };
    Header header{};
    if (bytes.size() < sizeof(header))
        return bad(std::to_string(bytes.size()) + " bytes, fewer than its header has");
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != k_magic)
        return bad("it does not begin as cooked data does");
    if (header.byte_order != k_byte_order)
        return bad("it was cooked on a machine with another byte order");
    if (header.version != k_cooked_version)
        return bad("it has version " + std::to_string(header.version) + ", this module reads version " +
                   std::to_string(k_cooked_version) + ": cook it again");
    if (header.kind != kind)
        return bad(kind == CookedKind::cloth ? "it is not a cloth" : "it is not a collider");
    if (header.bytes != bytes.size())
        return bad(std::to_string(bytes.size()) + " bytes, its header states " + std::to_string(header.bytes));
    if (checksum_of(bytes) != header.checksum)
        return bad("its checksum is wrong: it was changed or damaged");
    return CookedReader(bytes);
}

CookedBytes keep_cooked(std::span<const std::byte> bytes, std::shared_ptr<const void> owner)
{
    if (owner && reinterpret_cast<uintptr_t>(bytes.data()) % k_cooked_alignment == 0)
        return {bytes, std::move(owner)};
    static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= k_cooked_alignment);
    auto copy = std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
    return {*copy, copy};
}

} // namespace voile
