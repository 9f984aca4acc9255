// A program with the installed module alone: what it needs, and how it refuses null handles.
#include <voile/cloth.hpp>

#include <cstdio>

int main()
{
    const auto solver = voile::Solver::create({}, {});
    std::printf("%zu device extensions; %s\n", voile::requirements().device_extensions.size(),
                solver ? "made of nothing" : solver.error().message.c_str());
    return solver ? 1 : 0;
}
