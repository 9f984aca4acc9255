// Scenes of a few words, and the message that each is refused with.
#pragma once

#include "samples/viewer/scene_file.hpp"

#include <string>

namespace scene_text
{

inline const std::string k_grid = R"("grid": {"vertices": [4, 3], "size": [1, 2]})";

inline voile::Result<viewer::SceneFile> parse(const std::string& text)
{
    return viewer::parse_scene(text, "dir/s.json");
}

inline std::string message(const std::string& text)
{
    const auto result = parse(text);
    return result ? "accepted" : result.error().message;
}

// Of a scene with one cloth: a grid, and `rest`.
inline std::string cloth_message(const std::string& rest)
{
    return message("{\"cloths\": [{" + k_grid + ", " + rest + "}]}");
}

inline std::string collider_message(const std::string& collider)
{
    return message("{\"cloths\": [{" + k_grid + "}], \"colliders\": [" + collider + "]}");
}

// Of a scene with one cloth, and `rest` beside it.
inline std::string scene_message(const std::string& rest)
{
    return message("{\"cloths\": [{" + k_grid + "}], " + rest + "}");
}

} // namespace scene_text
