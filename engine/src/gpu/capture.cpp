// Capture: loads RenderDoc's library and calls its in-application interface.
#include "voile/engine/gpu/capture.hpp"

#include "voile/engine/gpu/device.hpp"

#ifdef VOILE_HAS_RENDERDOC
#include <renderdoc_app.h>

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <filesystem>

namespace voile::engine
{

namespace
{

// Already loaded if started from RenderDoc's UI, else loaded from the usual folders (Debian has one of its own).
void* open_library()
{
    if (void* library = dlopen("librenderdoc.so", RTLD_NOW | RTLD_NOLOAD))
        return library;
    for (const char* path :
         {"librenderdoc.so", "/usr/lib/x86_64-linux-gnu/renderdoc/librenderdoc.so",
          "/usr/lib/aarch64-linux-gnu/renderdoc/librenderdoc.so", "/usr/lib/renderdoc/librenderdoc.so"})
        if (void* library = dlopen(path, RTLD_NOW))
            return library;
    return nullptr;
}

RENDERDOC_API_1_4_1* api_of(void* api)
{
    return static_cast<RENDERDOC_API_1_4_1*>(api);
}

} // namespace

Capture::Capture(const std::string& path_template)
{
    // The implicit layer that hooks Vulkan is off unless this is set before the instance is made.
    setenv("ENABLE_VULKAN_RENDERDOC_CAPTURE", "1", 1);
    void* library = open_library();
    if (library == nullptr)
        throw StartupError("--capture: RenderDoc is not installed (Debian: renderdoc, librenderdoc-dev)");
    const auto get_api = reinterpret_cast<pRENDERDOC_GetAPI>(dlsym(library, "RENDERDOC_GetAPI"));
    if (get_api == nullptr || get_api(eRENDERDOC_API_Version_1_4_1, &api_) != 1)
        throw StartupError("--capture: this RenderDoc has no in-application interface 1.4.1");
    api_of(api_)->SetCaptureFilePathTemplate(path_template.c_str());
    api_of(api_)->MaskOverlayBits(eRENDERDOC_Overlay_None, eRENDERDOC_Overlay_None);
}

void Capture::begin()
{
    api_of(api_)->StartFrameCapture(nullptr, nullptr);
}

std::string Capture::end()
{
    const uint32_t before = api_of(api_)->GetNumCaptures();
    if (api_of(api_)->EndFrameCapture(nullptr, nullptr) != 1 || api_of(api_)->GetNumCaptures() == before)
        throw StartupError("--capture: RenderDoc could not write the capture");
    std::array<char, 4096> path{};
    auto length = static_cast<uint32_t>(path.size());
    api_of(api_)->GetCapture(before, path.data(), &length, nullptr);
    return path.data();
}

} // namespace voile::engine

#else

namespace voile::engine
{

Capture::Capture(const std::string&)
{
    throw StartupError("--capture: built without RenderDoc's header (Debian: librenderdoc-dev)");
}
void Capture::begin() {}
std::string Capture::end()
{
    return {};
}

} // namespace voile::engine

#endif
