// Cooked data: the expensive part of adding a mesh, computed once, kept in a file, shared by all instances of the mesh.
//
//   auto asset = cook(MeshCloth{.positions = ..., .triangles = ..., .material = wool()}); // slow, once
//   write(asset.value().bytes());                                                     // a file of the host's
//   ...
//   auto asset = CookedCloth::load(bytes, owner);                                       // checked, not copied
//   solver.add_cloth({.transform = here, .material = wool(), .cooked = asset.value()});  // as often as needed
//
// The bytes are for the version of the module that wrote them and for little-endian machines. load refuses bytes of
// other versions and damaged data: cook the mesh again. The bytes hold no paths, names or pointers. Loading is safe for
// any bytes: load returns an error or data that is safe to use. It does not prove that cook made the data: a forged
// file can hold a cloth with any springs.
#pragma once

#include "voile/export.hpp"
#include "voile/jobs.hpp"

#include "voile/result.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace voile
{

struct MeshCloth;
struct MeshCollider;

// A cloth mesh with its springs, folds and membrane. Copies share the data, which never changes; any thread may
// use them. A default-constructed one holds nothing.
class VOILE_API CookedCloth
{
public:
    CookedCloth() = default;
    explicit operator bool() const { return state_ != nullptr; }

    // The bytes for a file, which load takes. Empty if this holds nothing.
    [[nodiscard]] std::vector<std::byte> bytes() const;
    // An `owner` keeps the bytes alive and unchanged. With one, nothing is copied if the bytes begin at a multiple of
    // 16. Errors: data of another kind, version or byte order, data that is incomplete, damaged or out of range.
    static Result<CookedCloth> load(std::span<const std::byte> bytes, std::shared_ptr<const void> owner = {},
                                    const Jobs& jobs = {});

    [[nodiscard]] uint32_t vertices() const;
    [[nodiscard]] uint32_t triangles() const;

    struct State; // of the implementation
    explicit CookedCloth(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    [[nodiscard]] const std::shared_ptr<const State>& state() const { return state_; }

private:
    std::shared_ptr<const State> state_;
};

// A mesh collider that keeps its shape, with its hierarchy. Its members are like those of CookedCloth.
class VOILE_API CookedCollider
{
public:
    CookedCollider() = default;
    explicit operator bool() const { return state_ != nullptr; }

    [[nodiscard]] std::vector<std::byte> bytes() const;
    static Result<CookedCollider> load(std::span<const std::byte> bytes, std::shared_ptr<const void> owner = {},
                                       const Jobs& jobs = {});

    [[nodiscard]] uint32_t triangles() const; // those with an area

    struct State; // of the implementation
    explicit CookedCollider(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    [[nodiscard]] const std::shared_ptr<const State>& state() const { return state_; }

private:
    std::shared_ptr<const State> state_;
};

// Uses the positions, triangles, texture coordinates and transform of the description. Of its material it uses only
// whether it is a Fabric or a Material and whether it bends isometrically. Errors: those of Solver::add_cloth.
VOILE_API Result<CookedCloth> cook(const MeshCloth& cloth, const Jobs& jobs = {});

// Uses the positions, triangles and transform. Errors: those of Solver::add_collider; a mesh that deforms.
VOILE_API Result<CookedCollider> cook(const MeshCollider& collider, const Jobs& jobs = {});

} // namespace voile
