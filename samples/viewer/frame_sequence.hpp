// A mesh that deforms: the files of a sequence, one topology, and where its vertices are at a time.
#pragma once

#include "samples/viewer/scene_file.hpp"

#include "voile/engine/assets/mesh.hpp"

namespace viewer
{

// "walk" of walk_%04d.obj; "frames" of %d.obj
std::string sequence_name(const FrameSequence& entry);

class MeshSequence
{
public:
    // Reads all files. A vertex is a position of the file, in its order. `mesh`, where it is not empty, is a file that
    // must have the same topology. Errors name the file: one that is missing or cannot be read, another number of
    // vertices or other triangles than the first has.
    static voile::Result<MeshSequence> load(const FrameSequence& entry, const std::filesystem::path& mesh = {});

    // The first file's: the mesh at time 0. Triangles that have no area there are left out for good.
    [[nodiscard]] const voile::engine::Mesh& first() const { return first_; }
    [[nodiscard]] const voile::engine::Bounds& bounds() const { return bounds_; } // of all files
    [[nodiscard]] size_t frames() const { return frames_.size(); }
    [[nodiscard]] double duration() const; // s, from the first file to the last; infinite for a loop

    // One a vertex. Frame f is there at f / rate s; between two, vertices go along straight lines. Before the first it
    // is the first, and after the last the last. In a loop the first follows the last 1 / rate s later.
    void positions_at(double seconds, std::vector<glm::vec3>& positions) const;

private:
    voile::engine::Mesh first_;
    voile::engine::Bounds bounds_;
    std::vector<std::vector<glm::vec3>> frames_; // positions
    double rate_ = 60;                           // frames per second
    bool loop_ = false;
    float ramp_ = 0; // s
};

} // namespace viewer
