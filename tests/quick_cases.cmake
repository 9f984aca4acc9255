# The cases that `scripts/test.sh --quick` runs: every subject has some, and together they take under 3 minutes on two cores.
# ctest reads this file after it has found all cases (tests/CMakeLists.txt), and labels those named here `quick`. A name
# without a case, and a subject that is not named here, become tests that fail.
cmake_policy(VERSION 3.25)

function(quick_problem text)
    add_test("quick_cases.cmake: ${text}" /bin/sh -c "exit 1")
    set_tests_properties("quick_cases.cmake: ${text}" PROPERTIES LABELS quick)
endfunction()

# quick(subject case ...): without cases, all cases of the subject.
function(quick subject)
    list(APPEND quick_subjects ${subject})
    set(quick_subjects ${quick_subjects} PARENT_SCOPE)
    set(names ${ARGN})
    list(TRANSFORM names PREPEND "${subject}:")
    if(NOT names)
        set(names ${${subject}_TESTS})
    endif()
    foreach(name IN LISTS names)
        if(name IN_LIST ${subject}_TESTS)
            set_tests_properties("${name}" PROPERTIES LABELS quick)
        elseif(${subject}_TESTS) # otherwise it is not built, which has a failing test of its own
            quick_problem("no case is named \"${name}\"")
        endif()
    endforeach()
endfunction()

quick(test_assets)
quick(test_bvh)
quick(test_contact
    "a substep with planes and spheres equals their formulas"
    "what comes round an edge of a mesh is neither drawn into it nor stopped"
    "friction of a pair is the geometric mean of both sides"
    "friction holds stiff cloth on triangles"
    "a vertex pressed between two sheets closer than the thickness comes out of neither"
    "no path crosses a formula solid, however fast, flat and thin, and none that misses it is stopped"
    "lists of near triangles change no bit of what contact finds"
    "a round mesh has no features, a box of triangles has 12 edges and 8 corners")
quick(test_edits
    "a material changes while the cloth hangs, in the same buffers"
    "a material that does not fit the cloth is refused, and the old one stays"
    "a cloth is put back to its start, moved at once and given a velocity"
    "a snapshot brings the state back to the bit, also by way of the host"
    "a cloth at its strain limit hangs still")
quick(test_energy "a crumpled free cloth stays where it is")
quick(test_fabric
    "the air drags and lifts a tilted plate by 1/2 rho C |u| u along its normal and across it"
    "10 km from the origin cloth hangs as it does there, and comes to rest, and at 100 km it is finite"
    "a plate that falls face on reaches its terminal speed"
    "every preset is found by its name, valid, and on a grid of its own stretch and shear")
quick(test_frame)
quick(test_hard_contacts
    "the three long edges of a needle pass through the triangle that it pierces"
    "a sheet that lies in a box is as deep as it is"
    "a strip that hangs through an open ground sticks out at its shorter end")
quick(test_hazards)
quick(test_hello_cloth)
quick(test_holds
    "pins follow an anchor exactly, with its velocity, and stop with it"
    "pins change at run time, and what is let go falls"
    "a leash keeps a vertex near a moving place, a backstop in front of it"
    "tethers measure the way over the cloth"
    "holds and tethers refuse bad input, and nothing changes"
    "vertices are attached to a collider's surface")
quick(test_integration
    "a short trajectory follows the reference"
    "a spring pair swings with period 2 pi sqrt(m / 2 k)"
    "normals are the normals of a curved sheet")
quick(test_lifetime
    "a default-constructed id names nothing, and ids compare"
    "an upload and a snapshot may outlive their solver"
    "lifetime checks end the program where something goes while its commands run"
    "a device that has what requirements() lists is enough for the default options"
    "each limit of a device has its line"
    "a step out of range is refused by name, and nothing is recorded"
    "pins come to rest and go on with their anchor while an upload is due"
    "statistics in flight survive an upload")
quick(test_membrane
    "warp and weft follow the texture coordinates, and turn with the mesh where there are none")
quick(test_mesh_cloth
    "a cantilever of isometric bending sags alike as mesh and as grid"
    "a mesh that cannot be a cloth is refused by name, and the solver stays as it was")
quick(test_moving_colliders
    "an upload in the middle keeps a deformed mesh as it is"
    "what a deforming collider cannot take is refused"
    "what a collider cannot do is refused and changes nothing"
    "cloth meets the colliders of its layers alone")
quick(test_physics
    "the period of a spring pair, with either integrator"
    "a falling plate reaches its terminal speed all over")
quick(test_recovery
    "a small cloth comes out of the inside of a ball of 20,736 triangles"
    "inside is told right at edges, at corners and in slivers")
quick(test_model)
quick(test_refit)
quick(test_renderer)
quick(test_scene_meshes)
quick(test_stability
    "damping of springs that fall into one line is as stable as in a plane"
    "two slivers in a small mesh are still few, and many are the mesh's own")
quick(test_static_friction)
quick(test_statistics
    "vertices under a surface are counted, and the deepest is measured"
    "inside a mesh is where it winds around a vertex, at any depth"
    "values that are not finite are counted, and do not spoil the other sums")
quick(test_verlet
    "a Verlet step of one and of several substeps equals the double-precision reference"
    "a short Verlet trajectory follows the reference, of a grid and of meshes"
    "a Verlet cloth with contact stays above the surface")
quick(test_viewer
    "a pipe in place of a scene or a mesh keeps no signal waiting, and is refused"
    "a cloth is noted when it is softened first, and not again"
    "a mesh that cannot be used is named with its line and the reason"
    "a scene that cannot be used is named with its place and the reason"
    "options that cannot be used are named"
    "without Vulkan there is one line that says so"
    "validation messages make the exit code 2"
    "a point cache holds every frame, several cloths get a file each"
    "a scene of meshes, moving pins, tethers and gusts runs, and what is odd about a mesh is told"
    "a run without frames has the state of the start"
    "the jelly scene runs at a coarse resolution, and its cloth stays outside")
quick(test_viewer_parts)

get_cmake_property(variables VARIABLES)
foreach(variable IN LISTS variables)
    if(variable MATCHES "^(test_.*)_TESTS$" AND NOT CMAKE_MATCH_1 IN_LIST quick_subjects)
        quick_problem("the subject ${CMAKE_MATCH_1} has no quick case")
    endif()
endforeach()
