// ShaderSet.
#include "render/shader_set.hpp"

#include "voile_engine_shaders.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace voile::engine
{

namespace
{

constexpr auto k_names = std::to_array<std::string_view>({"dot.vert", "flagged_dot.vert", "height.vert", "line.vert",
                                                          "mark.frag", "shadow.vert", "sky.frag", "sky.vert",
                                                          "surface.frag", "surface.vert", "wire.frag"});

std::span<const uint32_t> embedded(std::string_view name)
{
    const std::array<std::span<const uint32_t>, k_names.size()> code{
        shaders::k_dot_vert,     shaders::k_flagged_dot_vert, shaders::k_height_vert, shaders::k_line_vert,
        shaders::k_mark_frag,    shaders::k_shadow_vert,      shaders::k_sky_frag,    shaders::k_sky_vert,
        shaders::k_surface_frag, shaders::k_surface_vert,     shaders::k_wire_frag};
    const auto* const found = std::ranges::find(k_names, name);
    assert(found != k_names.end());
    return code[static_cast<size_t>(found - k_names.begin())];
}

} // namespace

std::span<const std::string_view> shader_names()
{
    return k_names;
}

Result<ShaderSet> ShaderSet::with(const ShaderSet& base, const std::vector<ShaderCode>& replacements)
{
    ShaderSet set = base;
    for (const ShaderCode& shader : replacements)
    {
        if (std::ranges::find(k_names, shader.name) == k_names.end())
            return Error{"the renderer has no shader \"" + shader.name + "\""};
        set.replaced_[shader.name] = shader.spirv;
    }
    return set;
}

std::span<const uint32_t> ShaderSet::operator[](std::string_view name) const
{
    const auto found = replaced_.find(name);
    return found != replaced_.end() ? std::span<const uint32_t>(found->second) : embedded(name);
}

} // namespace voile::engine
