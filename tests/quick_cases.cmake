# The cases that `scripts/test.sh --quick` runs: some of every subject, together under 3 minutes on two cores. The tests
# with these cases have the label `quick` (register_cases.cmake).

# quick(subject case ...): without cases, all cases of the subject.
function(quick subject)
    list(APPEND quick_subjects ${subject})
    set(quick_subjects ${quick_subjects} PARENT_SCOPE)
    set(quick_cases_of_${subject} ${ARGN} PARENT_SCOPE)
endfunction()

quick(test_assets)
quick(test_attachments
    "pins follow an anchor exactly, move with its velocity, and stop with it"
    "pins change at run time, and released vertices fall"
    "a max-distance constraint keeps a vertex near a moving point, a backstop in front of it"
    "tethers measure distances along the cloth"
    "attachments and tethers refuse bad input, and nothing changes"
    "vertices are attached to a collider's surface")
quick(test_bench)
quick(test_bvh)
quick(test_command_reuse)
quick(test_contact
    "a substep with planes and spheres equals their formulas"
    "a vertex that passes around an edge of a mesh is neither pulled in nor stopped"
    "friction of a pair is the geometric mean of both sides"
    "friction holds stiff cloth on triangles"
    "a vertex pressed between two sheets closer than the thickness passes through neither"
    "no path crosses an analytic solid, however fast, flat or thin, and no path that misses it is stopped"
    "lists of near triangles change no bit of contact"
    "a sharp edge keeps all parts that are longer than the spacing, and else a vertex within it"
    "a round mesh has no features, a box of triangles has 12 edges and 8 corners")
quick(test_depenetration
    "a small cloth leaves the inside of a ball of 20,736 triangles"
    "the inside test is right at edges, at corners and in slivers")
quick(test_edits
    "a material changes while the cloth hangs, without new buffers"
    "a material that does not fit the cloth is refused, and the old one is kept"
    "a cloth is reset, teleported and given a velocity"
    "a snapshot restores the state to the bit, also through the host"
    "a cloth at its strain limit hangs still")
quick(test_energy "the center of mass of a crumpled free cloth stays at rest")
quick(test_sleep
    "a cloth falls asleep after half a second below its sleep_speed, and not above"
    "cloth that contact moves without a velocity does not fall asleep"
    "a hanging cloth sleeps once it is calm, and wakes when its anchor moves, not when another one does"
    "a collider that moves far away, or of other layers, does not wake cloth"
    "a snapshot of cloth that sleeps: it sleeps on if nothing changed, and wakes if anything did"
    "commands that are used again are used as cloths fall asleep, sleep and wake"
    "a cloth that flies at one that sleeps meets it as if it had never slept"
    "a sleep_speed out of range is an error, and nothing changes")
quick(test_softened_limit "cloth gets and loses the limit of softened cloth with the substeps of a step")
quick(test_fabric
    "air drags and lifts a tilted plate by 1/2 rho C |u| u along and across its normal"
    "cloth 10 km from the origin hangs and rests as at the origin, and 100 km from it stays finite"
    "a plate that falls face on reaches its terminal speed"
    "every preset is found by name, is valid, and keeps its stretch and shear on a grid")
quick(test_frame)
quick(test_hard_contacts
    "the three long edges of a needle pass through the triangle that it pierces"
    "the depth of a sheet in a box is exact"
    "the depth of a strip through an open ground is its shorter end")
quick(test_hazards)
quick(test_intersections
    "an edge and a triangle intersect where they touch, and are apart by one bit"
    "triangles without an area and edges without a length are points and segments"
    "the filter of the exact reference never contradicts whole numbers"
    "whole numbers are exact beyond the range of doubles"
    "a flat sheet does not intersect itself, a rolled one does"
    "sheets intersect where they cross, overlap in a plane, or touch in one vertex"
    "intersections are counted exactly far from the origin"
    "small coordinates beside large ones have exact signs"
    "only cloths with a common layer intersect, and removed and disabled ones do not"
    "a solver counts intersections only if its options say so"
    "a deforming collider intersects cloth where its vertices are"
    "a triangle that touches a solid to within rounding is uncertain, and counts"
    "one vertex pushed a micrometer through a collider is seen, unless no layer is shared")
quick(test_integration
    "a short trajectory follows the reference"
    "a spring pair swings with period 2 pi sqrt(m / 2 k)"
    "normals are the normals of a curved sheet")
quick(test_output
    "outputs write what is asked for at the host's offsets and strides, and nothing else"
    "outputs that cannot be are refused, and ids that name none"
    "previous positions are the positions before the last step, to the bit"
    "a step that resets or teleports a cloth leaves it without motion"
    "without options the vertex streams cost no memory and no dispatch"
    "the index buffer has the triangles of grids and meshes")
quick(test_lifetime
    "a default-constructed id names nothing, and ids compare"
    "an upload and a snapshot may outlive their solver"
    "lifetime checks end the program if an object is destroyed while its commands run"
    "a device that meets requirements() is enough for the default options"
    "each limit of a device has an error message"
    "a wrong or missing name in a set is an error that names kernel and binding"
    "docs/buffers.md lists who reads and who writes each buffer"
    "a step out of range is refused by name, and nothing is recorded"
    "pins rest and move with their anchor while an upload is due"
    "substeps of a step hold for every cloth"
    "a budget of substeps is kept, and what it costs in stiffness is named"
    "statistics in flight survive an upload")
quick(test_membrane
    "warp and weft follow the texture coordinates, or rotate with a mesh that has none")
quick(test_mesh_cloth
    "a cantilever with isometric bending sags equally as a mesh and as a grid"
    "a mesh that cannot be a cloth is refused by name, and the solver is unchanged")
quick(test_model)
quick(test_moving_colliders
    "an upload preserves a deformed mesh"
    "invalid input of a deforming collider is refused"
    "invalid input of a collider is refused and changes nothing"
    "cloth touches only the colliders of its layers")
quick(test_physics
    "a spring pair swings with its exact period under either integrator"
    "a falling plate reaches its terminal speed all over")
quick(test_refit)
quick(test_renderer)
quick(test_samples
    "the shooting method gives the known drops of a heavy elastica")
quick(test_scene_meshes)
quick(test_self_collision
    "a capacity of lists of pairs out of its range is refused"
    "a sheet that collides with itself falls freely as one that does not"
    "cloth slides down on cloth as Coulomb's law says"
    "islands are the cloths that may reach each other, whatever their order"
    "pins that are driven through each other force pairs, and no intersection is left after they part"
    "tangled pairs are counted as they are when the step starts, within a cloth and between cloths"
    "without untangling, sheets that start in each other stay so, and nothing is counted")
quick(test_stability
    "damping of springs folded into one line is as stable as in a plane"
    "two slivers in a small mesh are softened, many slivers are not")
quick(test_static_friction
    "every preset sticks and slips within 1 % of the incline's tangent"
    "static friction holds on a collider of constant velocity as on one at rest")
quick(test_statistics
    "vertices under a surface are counted, and the deepest is measured"
    "a vertex is inside a mesh if the mesh winds around it, at any depth"
    "values that are not finite are counted and do not spoil the other sums")
quick(test_verlet
    "a Verlet step of one and of several substeps equals the double-precision reference"
    "a short Verlet trajectory of a grid and of meshes follows the reference"
    "a Verlet cloth with contact stays above the surface")
quick(test_viewer
    "a pipe instead of a scene or a mesh is refused and delays no signal"
    "a cloth is noted when it is first softened, and not again"
    "a mesh that cannot be used is named with its line and the reason"
    "a scene that cannot be used is named with its path and the reason"
    "options that cannot be used are named"
    "a run without Vulkan prints one line that says so"
    "validation messages make the exit code 2"
    "a point cache holds the start and every frame, and each of several cloths gets a file"
    "a scene of meshes, moving pins, tethers and gusts runs, and irregularities of a mesh are reported"
    "a run without frames has the state of the start"
    "exports hold the start, every frame and the end, of cloths and colliders"
    "the jelly scene runs at a coarse resolution, and its cloth stays outside")
quick(test_viewer_parts)
quick(test_window
    "a changed shader changes the picture, and a broken one is reported by its line"
    "a period takes one step while paused, and R starts again"
    "a window is resized, and Escape closes it")
