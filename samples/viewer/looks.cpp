#include "samples/viewer/looks.hpp"

#include "voile/cloth_component.hpp"

#include <array>

namespace viewer
{
namespace
{

using EngineSurface = voile::engine::Surface;

struct Colors
{
    glm::vec3 front; // linear
    glm::vec3 back;
};

constexpr std::array<Colors, 4> k_colors{{
    {{0.50f, 0.04f, 0.07f}, {0.42f, 0.30f, 0.16f}},
    {{0.05f, 0.16f, 0.38f}, {0.40f, 0.36f, 0.28f}},
    {{0.06f, 0.28f, 0.17f}, {0.42f, 0.34f, 0.20f}},
    {{0.50f, 0.26f, 0.04f}, {0.30f, 0.10f, 0.12f}},
}};

// What the look of a preset differs in from that of cloth without one.
void apply_preset(const std::string& preset, EngineSurface& surface)
{
    if (preset == "silk")
    {
        surface.weave = EngineSurface::Weave::satin;
        surface.pattern = EngineSurface::Pattern::none;
        surface.roughness = 0.32f;
        surface.translucency = 0.3f;
        surface.back_color = 0.75f * surface.base_color; // the same threads, duller
    }
    else if (preset == "wool")
    {
        surface.weave = EngineSurface::Weave::twill;
        surface.pattern = EngineSurface::Pattern::stripes;
        surface.roughness = 0.9f;
        surface.sheen = 0.6f;
        surface.translucency = 0.04f;
        surface.back_color = surface.base_color;
    }
    else if (preset == "denim")
    {
        surface.weave = EngineSurface::Weave::twill;
        surface.pattern = EngineSurface::Pattern::none;
        surface.base_color = {0.02f, 0.05f, 0.17f}; // dyed warp
        surface.back_color = {0.32f, 0.36f, 0.42f}; // plain weft
        surface.roughness = 0.85f;
        surface.sheen = 0.12f;
        surface.translucency = 0.02f;
    }
    else if (preset == "leather")
    {
        surface.weave = EngineSurface::Weave::grain;
        surface.pattern = EngineSurface::Pattern::none;
        surface.base_color = {0.17f, 0.07f, 0.03f};
        surface.back_color = {0.30f, 0.19f, 0.11f}; // suede
        surface.roughness = 0.42f;
        surface.sheen = 0;
        surface.translucency = 0;
    }
}

template <typename T>
void replace(T& value, const std::optional<T>& by)
{
    value = by.value_or(value);
}

} // namespace

voile::engine::Surface solid_surface(const SolidLookEntry& look)
{
    EngineSurface surface;
    surface.base_color = look.color.value_or(glm::vec3(0.66f, 0.60f, 0.50f));
    surface.roughness = look.roughness.value_or(0.45f);
    surface.metallic = look.metallic.value_or(0.f);
    return surface;
}

voile::engine::Surface cloth_surface(const ClothEntry& cloth, size_t index, float size)
{
    const Colors& colors = k_colors[index % k_colors.size()];
    EngineSurface surface = voile::component::fabric_surface(colors.front, colors.back, size);
    apply_preset(cloth.material.preset.value_or(""), surface);
    const LookEntry& look = cloth.look;
    if (look.color) // by default both sides have it
        surface.back_color = 0.75f * *look.color;
    replace(surface.base_color, look.color);
    replace(surface.back_color, look.back_color);
    replace(surface.weave, look.weave);
    replace(surface.pattern, look.pattern);
    replace(surface.weave_scale, look.threads);
    replace(surface.roughness, look.roughness);
    replace(surface.sheen, look.sheen);
    replace(surface.translucency, look.translucency);
    return surface;
}

} // namespace viewer
