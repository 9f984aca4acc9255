// A host that steps cloth on a queue that only computes, and draws on another one.
#include "falling_sheet.hpp"

#include <stdexcept>

int main()
{
    try
    {
        foreign::Engine engine({.compute_only = true});
        return let_a_sheet_fall(engine, handles_of(engine), {.host_scopes = voile::HostScopes{}});
    }
    catch (const std::runtime_error& error)
    {
        std::printf("skipped: %s\n", error.what());
        return 77;
    }
}
