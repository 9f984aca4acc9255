// ShaderSet: the renderer's shaders by name: those that are embedded, or others in their place.
#pragma once

#include "voile/engine/render/renderer.hpp"

#include <map>
#include <string_view>

namespace voile::engine
{

class ShaderSet
{
public:
    ShaderSet() = default;
    // An error for an unknown name. Later entries win.
    static Result<ShaderSet> with(const ShaderSet& base, const std::vector<ShaderCode>& replacements);

    // `name`: of shader_names().
    [[nodiscard]] std::span<const uint32_t> operator[](std::string_view name) const;

private:
    std::map<std::string, std::vector<uint32_t>, std::less<>> replaced_;
};

} // namespace voile::engine
