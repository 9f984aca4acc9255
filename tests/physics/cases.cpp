#include "physics/cases.hpp"

namespace physics
{

const std::vector<Case>& all_cases()
{
    static const std::vector<Case> cases = {
        {"free fall", "A sheet with half the critical internal damping falls for 0.5 s.", free_fall},
        {"order of the integrators",
         "Two vertices on a spring swing for 1 s; the slope of the error as the step is halved.", order},
        {"spring pair", "Two vertices of 0.2 kg on a spring of 50 N/m; the phase after four periods.", spring_pair},
        {"energy", "A free cloth without damping, stretched by 3 % and released, for 10 s.", energy},
        {"hanging sheet", "1 m square, 0.2 kg/m², 1 kN/m, held along its upper edge.", hanging_sheet},
        {"catenary", "A strip held at both ends; its sag over its length.", catenary},
        {"hanging chain", "A strip of 1 m, started in the shape of each of its first two modes.", hanging_chain},
        {"terminal speed", "A flat sheet of 0.2 kg/m² falls face on, C_n = 1.28, for 1.5 s.", terminal_speed},
        {"cantilever, grid", "A strip clamped at its first two columns, isometric bending, Γ = w L³ / B.",
         cantilever_grid},
        {"cantilever, mesh", "The same strip of equilateral triangles.", cantilever_mesh},
        {"incline",
         "Patches of 8 cm of the presets, side by side on an incline of 30° for 0.25 s; kinetic friction 0.5.",
         incline},
        {"strap", "Light straps over half a triangulated cylinder, a weight at each end, friction 0.3.", strap},
        {"drape", "A disc of 30 cm, held on 18 cm, comes to rest; the presets on a triangle mesh.", drape},
    };
    return cases;
}

} // namespace physics
