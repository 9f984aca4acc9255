// make_meshes OUTPUT_DIR: writes the meshes of the sample scenes as OBJ.
#include "figure.hpp"
#include "garments.hpp"
#include "gem.hpp"
#include "heart.hpp"
#include "label.hpp"

#include "voile/engine/assets/obj.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

namespace
{

bool save(const std::filesystem::path& path, const voile::engine::Mesh& mesh)
{
    const voile::Result<void> saved = voile::engine::save_obj(path, mesh);
    if (!saved)
        std::fprintf(stderr, "make_meshes: %s\n", saved.error().message.c_str());
    return saved.has_value();
}

bool save_jelly(const std::filesystem::path& folder)
{
    for (uint32_t i = 0; i < scenes::k_jelly_frames; ++i)
        if (!save(folder / ("jelly_" + std::to_string(i) + ".obj"),
                  scenes::make_jelly(static_cast<double>(i) / scenes::k_jelly_rate)))
            return false;
    return true;
}

bool save_dressed(const std::filesystem::path& folder)
{
    const scenes::Figure figure;
    for (uint32_t i = 0; i < scenes::k_walk_frames; ++i)
        if (!save(folder / ("figure_" + std::to_string(i) + ".obj"),
                  figure.at(static_cast<double>(i) / scenes::k_walk_frames)))
            return false;
    return save(folder / "skirt.obj", scenes::make_skirt()) &&
           save(folder / "cape.obj", scenes::make_cape(figure.at(0)));
}

bool save_labels(const std::filesystem::path& folder)
{
    constexpr float k_height = 0.07f; // m
    for (const char* text : {"silk",  "cotton", "wool", "denim", "leather", "12x12", "24x24", "48x48", "96x96", "0",
                             "0.002", "0.01",   "0.03", "0.05",  "0.1",     "0.2",   "0.3",   "0.6",   "0.8",   "1.28",
                             "2",     "5",      "20",   "500",   "1000",    "1e-6",  "3e-5",  "1e-3"})
        if (!save(folder / (std::string("label_") + text + ".obj"), scenes::make_label(text, k_height)))
            return false;
    return true;
}

int run(const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    const bool saved = save(folder / "heart.obj", scenes::make_reference_heart()) &&
                       save(folder / "ground.obj", scenes::make_ground()) &&
                       save(folder / "drape_heart.obj", scenes::make_drape_heart()) &&
                       save(folder / "gem.obj", scenes::make_gem()) &&
                       save(folder / "curtain.obj", scenes::make_curtain()) && save_jelly(folder) &&
                       save_dressed(folder) && save_labels(folder);
    return saved ? 0 : 1;
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 2)
    {
        std::fprintf(stderr, "usage: make_meshes OUTPUT_DIR\n");
        return 2;
    }
    try
    {
        return run(arguments[1]);
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "make_meshes: %s\n", error.what());
        return 1;
    }
}
