// The buffers of the solver, declared once. Kernels bind a buffer by its number (bindings.h), the solver
// allocates and binds it by its name, and docs/buffers.md lists who reads and writes it.
//
// VOILE_BUFFER(number, name, entry, count, meaning): a buffer that uploads allocate, and copy over where it has to
// grow. `count` is an expression over BufferCounts (device_state.hpp). A kernel that declares a binding of that name
// gets the buffer.
//
// VOILE_SCRATCH_BUFFER(number, name, entry, count, meaning): the same, but nothing in it outlives an upload.
//
// VOILE_OUTPUT_BUFFER(number, name, entry, count, meaning): the same as VOILE_BUFFER, for the host alone. Its count is
// 0, and it is not allocated, unless SolverOptions::output asks for it.
//
// VOILE_SOLVER_BUFFER(number, name, entry, meaning): a buffer that uploads leave alone.
//
// VOILE_HOST_BUFFER(number, name, entry, meaning): a buffer of the host's, another one in each set.
//
// VOILE_ROLE(number, name, entry, meaning): a binding whose buffer differs between descriptor sets. Each set names the
// buffer (set_descriptions.cpp).
//
// Numbers are unique; those of roles begin at buffer::k_numbers. A new line takes the next free number.

#ifndef VOILE_BUFFER
#define VOILE_BUFFER(number, name, entry, count, meaning)
#endif
#ifndef VOILE_SCRATCH_BUFFER
#define VOILE_SCRATCH_BUFFER(number, name, entry, count, meaning) VOILE_BUFFER(number, name, entry, count, meaning)
#endif
#ifndef VOILE_OUTPUT_BUFFER
#define VOILE_OUTPUT_BUFFER(number, name, entry, count, meaning) VOILE_BUFFER(number, name, entry, count, meaning)
#endif
#ifndef VOILE_SOLVER_BUFFER
#define VOILE_SOLVER_BUFFER(number, name, entry, meaning)
#endif
#ifndef VOILE_HOST_BUFFER
#define VOILE_HOST_BUFFER(number, name, entry, meaning) VOILE_SOLVER_BUFFER(number, name, entry, meaning)
#endif
#ifndef VOILE_ROLE
#define VOILE_ROLE(number, name, entry, meaning)
#endif

// clang-format off

// Cloths.
VOILE_BUFFER(0, cloths, ClothRecord, cloths, "size, springs, bounds, friction, drag of a cloth")
VOILE_SCRATCH_BUFFER(1, patches, Patch, patches, "the vertices of a workgroup, a copy of the data of their cloth that kernels need, whether they sleep, which are awake, and whether they are near features")
VOILE_SCRATCH_BUFFER(96, awake_dispatches, AwakeDispatch, VOILE_SUBSTEP_BATCHES, "the sizes of the indirect dispatches over the patches of each batch whose cloths are awake")
VOILE_BUFFER(95, sleeps, SleepRecord, cloths, "how long a cloth has been calm, where it then is, and which cloths sleep with it")
VOILE_BUFFER(2, mesh_vertices, MeshVertex, mesh_vertices, "the offsets and lengths of the lists of a mesh vertex")
VOILE_BUFFER(3, mesh_springs, MeshSpring, springs, "springs of mesh vertices; the lists of a workgroup are interleaved")
VOILE_BUFFER(4, mesh_corners, MeshCorner, corners, "triangles around mesh vertices, interleaved like springs")
VOILE_BUFFER(5, membrane_corners, MembraneCorner, corners, "the same triangles at rest, in warp and weft coordinates")
VOILE_BUFFER(98, mesh_fans, MeshFan, fans, "the wedges of the vertices of meshes that collide with themselves, and the owners around them")
VOILE_BUFFER(99, mesh_wedges, MeshWedge, wedges, "the triangles and edges that these vertices own")
VOILE_BUFFER(100, mesh_owners, uint, owners, "vertices that own primitives around them")
VOILE_BUFFER(101, limit_vertices, LimitVertex, limit_vertices, "the levels of the strain limit that a vertex is on")
VOILE_BUFFER(102, limit_levels, LimitLevel, limit_levels, "a vertex on one of these levels")
VOILE_BUFFER(103, limit_links, LimitLink, limit_links, "its neighbors there")
VOILE_BUFFER(104, limit_parents, LimitParent, limit_parents, "the vertices that a vertex moves with after the passes of the levels that it is not on")
VOILE_BUFFER(6, start, vec4, vertices, "start position, and the inverse of the area or mass scale that the density multiplies")
VOILE_BUFFER(7, start_residuals, uvec2, vertices, "residual of the start position")
VOILE_BUFFER(8, normals, vec4, vertices, "unit normal and 0; the host draws from it")

// The step that is recorded. A uniform buffer: each step writes it at its beginning.
VOILE_SCRATCH_BUFFER(92, step_inputs, StepInput, 1, "lengths, forces and numbers that may differ between steps with the same passes")

// The state between steps.
VOILE_BUFFER(9, positions, vec4, vertices, "position and inverse mass; the host draws from it")
VOILE_BUFFER(10, residuals, uvec2, vertices, "the rounding error of the position, in 40 bits (fine_position.glsl)")
VOILE_BUFFER(11, velocities, vec4, vertices, "velocity and flags (VOILE_VERTEX_*); the host draws from it")

// Stages of the integrators. Under Verlet the velocities of A and C are the predicted ones of the state and of stage B.
VOILE_SCRATCH_BUFFER(12, stage_a_positions, vec4, vertices, "RK4 stage 1; positions at the last contact pass, if it spans several substeps of Verlet; passes of the strain limit, the state before its guard")
VOILE_SCRATCH_BUFFER(13, stage_a_residuals, uvec2, vertices, "residuals of stage A")
VOILE_SCRATCH_BUFFER(14, stage_a_velocities, vec4, vertices, "RK4 stage 1, passes of the strain limit; velocities that Verlet predicts for the state")
VOILE_SCRATCH_BUFFER(15, stage_b_positions, vec4, vertices, "RK4 stages 2 and 4, Verlet: the positions that a substep proposes")
VOILE_SCRATCH_BUFFER(16, stage_b_residuals, uvec2, vertices, "residuals of stage B")
VOILE_SCRATCH_BUFFER(17, stage_b_velocities, vec4, vertices, "RK4 stages 2 and 4, Verlet: the velocities that a substep proposes")
VOILE_SCRATCH_BUFFER(18, stage_c_positions, vec4, vertices, "RK4 stage 3; angular velocities of neighborhoods after the strain limit, velocities before its guard")
VOILE_SCRATCH_BUFFER(19, stage_c_residuals, uvec2, vertices, "residuals of stage C")
VOILE_SCRATCH_BUFFER(20, stage_c_velocities, vec4, vertices, "RK4 stage 3; velocities that Verlet predicts for stage B")

// Attachments.
VOILE_SCRATCH_BUFFER(21, anchors, AnchorRecord, anchors, "the poses of an anchor at the step's start and end")
VOILE_SCRATCH_BUFFER(22, attachments, AttachmentRecord, attachments, "attachments; pins come first")
VOILE_SCRATCH_BUFFER(23, tethers, TetherRecord, tethers, "the tethers of a vertex")

// Colliders.
VOILE_BUFFER(24, colliders, ColliderRecord, colliders, "a collider at the pose at which it was added, and its origin")
VOILE_BUFFER(25, collider_motions, ColliderMotion, colliders, "the poses of a collider at the step's start and end")
VOILE_BUFFER(26, bvh_nodes, BvhNode, nodes, "hierarchies of rigid meshes")
VOILE_BUFFER(27, bvh_triangles, BvhTriangle, triangles, "triangles of rigid meshes, in leaf order")
VOILE_SCRATCH_BUFFER(28, deforming_input, float, deforming_vertices * k_most_stride / sizeof(float), "vertices of deforming meshes as the host gives them, up to 64 bytes per vertex")
VOILE_BUFFER(29, deforming_positions, vec4, 2 * deforming_vertices, "vertices of deforming meshes, twice: at the step's start and at its end")
VOILE_SCRATCH_BUFFER(91, deforming_reach, uint, 1, "m, the longest displacement of a deforming mesh's vertex in the step, as the bits of a float")
VOILE_BUFFER(30, padded_leaves, PaddedLeaf, padded_leaves, "triangles of deforming meshes")
VOILE_BUFFER(31, padded_boxes, PaddedBox, padded_boxes, "boxes of the hierarchies of deforming meshes, level by level")
VOILE_SCRATCH_BUFFER(32, near_colliders, uint, near_words, "per patch the box in which its list is valid, the range of its words that are not 0, and one bit per collider (VOILE_NEAR_*); empty with 8 colliders or fewer")

// Contact.
VOILE_SCRATCH_BUFFER(33, candidate_centers, vec4, vertices, "the query center and the radius in which the list of triangles near a vertex is valid")
VOILE_SCRATCH_BUFFER(34, candidate_triangles, uint, vertices * VOILE_CANDIDATE_WORDS, "the list of triangles near a vertex: its length, two radii, the triangles")
VOILE_SCRATCH_BUFFER(35, depenetrations, Depenetration, 2 + vertices, "workgroups of this step's and the next step's indirect dispatch, the next one cleared before it is written; then per vertex the collider that contains it, and its exit velocity")
VOILE_SCRATCH_BUFFER(85, contact_planes, ContactPlane, vertices, "the surface that a vertex touched in the last contact pass, if such passes span several substeps")
VOILE_BUFFER(36, depenetration_votes_even, uint, cloths * VOILE_VOTE_WORDS, "votes of even steps, per cloth: ballots of colliders, the side of its normals on which it leaves them and the sum of exit directions (VOILE_BALLOT_*)")
VOILE_BUFFER(37, depenetration_votes_odd, uint, cloths * VOILE_VOTE_WORDS, "votes of odd steps")
VOILE_BUFFER(38, feature_sets, FeatureSet, colliders, "the feature edges and vertices of a collider")
VOILE_BUFFER(39, feature_nodes, BvhNode, feature_nodes, "hierarchies of features")
VOILE_BUFFER(40, features, Feature, features, "a feature edge or vertex, and the direction that it faces")
VOILE_BUFFER(87, feature_sources, FeatureSource, feature_sources, "a feature edge or vertex of a deforming mesh, as indices")
VOILE_BUFFER(88, feature_hinges, FeatureHinge, feature_hinges, "the pairs of triangles from which it follows which way such a feature faces")
VOILE_BUFFER(89, feature_slots, uint, feature_slots, "per slot of a deforming mesh's hierarchy its first feature, and their number")
VOILE_BUFFER(90, feature_facings, FeatureFacing, 2 * feature_sources, "which way a feature of a deforming mesh faces, twice: at the step's start and at its end")
VOILE_SCRATCH_BUFFER(41, feature_corrections, FeatureCorrection, featured_vertices, "a shift, a change of velocity, and the substep in which they apply")
VOILE_SCRATCH_BUFFER(86, feature_guards, FeatureGuard, featured_vertices, "where a vertex near features may move in a substep")
VOILE_SCRATCH_BUFFER(42, feature_patches, uint, patches, "the patches that are near features")
VOILE_SCRATCH_BUFFER(43, feature_dispatch, uint, VOILE_SUBSTEP_BATCHES * VOILE_FEATURE_DISPATCH_WORDS, "the sizes of the indirect dispatches over feature items, over the patches near features and of a second query for them, with the numbers of items, for each batch of cloths; cleared before they are written")
VOILE_SCRATCH_BUFFER(105, feature_traversals, uint, VOILE_SUBSTEP_BATCHES * VOILE_TRAVERSAL_WORDS, "on CPU devices: the sizes of the dispatches for vertices whose items do not suffice, for each batch (VOILE_TRAVERSAL_*)")
VOILE_SCRATCH_BUFFER(79, feature_centers, FeatureCenter, featured_vertices, "the position of a vertex when near features were listed")
VOILE_SCRATCH_BUFFER(80, feature_cells, FeatureCell, featured_vertices, "per vertex which items are of its pieces")
VOILE_SCRATCH_BUFFER(81, feature_items, FeatureItem, feature_items, "features near pieces of cloth; levels of substeps have parts in proportion to their patches")
VOILE_SCRATCH_BUFFER(82, feature_responses, FeatureResponse, feature_items, "per item its last contact")

// Strain limit.
VOILE_SCRATCH_BUFFER(44, step_start_positions, vec4, vertices, "the positions at the start of a step with a strain limit")
VOILE_SCRATCH_BUFFER(45, step_start_residuals, uvec2, vertices, "residuals at the start of the step")
VOILE_SCRATCH_BUFFER(46, step_start_velocities, vec4, vertices, "velocities at the start of the step")
VOILE_SCRATCH_BUFFER(47, step_works_first, LimitWork, patches, "energy and work of the step, at its start")
VOILE_SCRATCH_BUFFER(48, step_works_last, LimitWork, patches, "energy and work of the step, at its end")
VOILE_SCRATCH_BUFFER(49, limit_works_before, LimitWork, patches, "energy and work of the limit, before it")
VOILE_SCRATCH_BUFFER(50, limit_works_after, LimitWork, patches, "energy and work of the limit, after it")
VOILE_BUFFER(51, limit_scales, LimitScale, cloths, "the fractions of the limit's changes that a cloth keeps, and its reserve of energy")

// Statistics.
VOILE_SCRATCH_BUFFER(52, partials, StatisticsRecord, patches, "statistics of a patch")
VOILE_SOLVER_BUFFER(53, statistics, StatisticsResult, "statistics of all cloths, one record per slot; the host reads it")

// Output.
VOILE_OUTPUT_BUFFER(54, previous_positions, vec4, previous_vertices, "the positions before the last step; the host reads it")
VOILE_OUTPUT_BUFFER(55, indices, uint, 3 * cloth_triangles, "triangles of a cloth, relative to its first vertex; the host draws with it")
VOILE_HOST_BUFFER(56, host_vertices, float, "a vertex buffer of the host's, which an output writes")

// Pairs of near primitives, in solvers with cloths that collide with themselves.
VOILE_BUFFER(57, pair_order, uvec2, pair_vertices, "vertices and their cloths, in the order of the leaves of the hierarchy of pairs")
VOILE_SCRATCH_BUFFER(58, pair_boxes, PaddedBox, pair_vertices == 0 ? 0 : 4 * pair_vertices, "boxes of the hierarchy of pairs")
VOILE_SCRATCH_BUFFER(59, pairs, uvec4, pair_vertices * VOILE_PAIRS, "per vertex the pairs of the primitives that it owns")
VOILE_SCRATCH_BUFFER(60, pair_distances, float, pair_vertices * VOILE_PAIRS, "the distances of these pairs, along their sweeps")
VOILE_SCRATCH_BUFFER(77, pair_thicknesses, float, pair_vertices * VOILE_PAIRS, "m, at which these pairs repel each other")
VOILE_SCRATCH_BUFFER(78, pair_references, uint, pair_vertices * VOILE_PAIR_CANDIDATES, "for each vertex the places of the pairs that it is in, in the lists; during a search the vertices that may be near it")
VOILE_SCRATCH_BUFFER(61, pair_lists, PairList, pair_vertices, "the distance up to which a vertex lists pairs, their number, and those that both sides list; during a search the lengths of its lists of candidates, and whether one is near")
VOILE_SCRATCH_BUFFER(62, pair_bounds, PairBound, pair_vertices == 0 ? 0 : 2 + pair_vertices, "the sizes of the dispatches that make the lists, not 0 if a vertex asks for it; then per vertex what bounds its motion")
VOILE_SCRATCH_BUFFER(63, pair_memories, PairMemory, pair_vertices, "what a vertex keeps from pass to pass")
VOILE_SCRATCH_BUFFER(64, pair_midpoints, vec4, pair_vertices, "the middle of the motion that the lists expect of a vertex, and half of its sweep")
VOILE_SCRATCH_BUFFER(84, pair_carries, uint, pair_vertices, "half of the way that the clock of the lists carries a vertex")
VOILE_SCRATCH_BUFFER(94, pair_islands, PairIsland, pair_vertices == 0 ? 0 : cloths, "how near cloths are to others that may meet them, and the clock of the lists that these share")
VOILE_SCRATCH_BUFFER(83, pair_flats, vec2, pair_vertices, "how far apart primitives around a vertex are unless they share a vertex, in two neighborhoods; not above 0 where that is unknown; before that, whether it is clear of colliders")
VOILE_SCRATCH_BUFFER(65, pair_passes, PairDispatch, pair_vertices == 0 ? 0 : VOILE_PAIR_PASSES, "the sizes of the dispatches of a pass")
VOILE_SCRATCH_BUFFER(97, next_pair_pass, PairDispatch, pair_vertices == 0 ? 0 : VOILE_PAIR_RESPOND + 1, "the sizes of the dispatches of the next pass, before it searches")
VOILE_SCRATCH_BUFFER(66, pair_entries, uint, pair_vertices * VOILE_PAIRS, "the places of the pairs that both sides list, in no order; during a search the places of the candidates that are sifted")
VOILE_SCRATCH_BUFFER(67, pair_responses, PairResponse, pair_vertices * VOILE_PAIRS, "what each listed pair does in a pass")
VOILE_SCRATCH_BUFFER(68, pair_loads, uint, 2 * pair_vertices, "the sums of the weights of a vertex in the pairs that are pushed, of even and of odd passes")
VOILE_SCRATCH_BUFFER(69, paired_vertices, uvec4, pair_vertices, "the vertices in pairs: vertex, cloth, first reference, number of references; in no order")
VOILE_SCRATCH_BUFFER(70, pair_masks, uint, pair_vertices == 0 ? 0 : 4 * pair_vertices + owners, "the pairs that each vertex is in, in the lists of the owners around it; during a search the vertices that search")

VOILE_SCRATCH_BUFFER(93, tangles, Tangle, pair_vertices, "the pairs around a vertex that intersect at the step's start, and the direction out of it")

// Intersections: hierarchies of cloths, with SolverOptions::intersections of all, else of those that collide with
// themselves; and with it what is counted.
VOILE_BUFFER(71, cloth_trees, TreeRecord, cloth_trees, "the hierarchies of the active cloths, ordered by depth")
VOILE_BUFFER(72, cloth_leaves, PaddedLeaf, cloth_leaves, "triangles of cloths; instances of a mesh, and grids of one size, share them")
VOILE_SCRATCH_BUFFER(73, cloth_boxes, PaddedBox, cloth_boxes, "boxes of the hierarchies of cloths, level by level")
VOILE_BUFFER(74, bvh_edges, uint, bvh_edges, "the edges that a triangle of a rigid mesh owns, one bit each")
VOILE_SCRATCH_BUFFER(75, intersections, uint, intersecting_vertices, "per vertex what the triangles and edges around it intersect: cloths, colliders (VOILE_INTERSECTS_*); the host draws from it")
VOILE_SCRATCH_BUFFER(76, intersection_counts, IntersectionCounters, intersecting_vertices == 0 ? 0 : 1, "the numbers of intersecting pairs")

// Integration: the state before the substep, the state that forces are evaluated at, and the state that is written.
VOILE_ROLE(128, base_positions, vec4, "RK4: the positions before the substep, and inverse masses")
VOILE_ROLE(129, base_residuals, uvec2, "RK4: the residuals before the substep")
VOILE_ROLE(130, base_velocities, vec4, "RK4: the velocities before the substep")
VOILE_ROLE(131, stage_positions, vec4, "the positions that the pass starts from")
VOILE_ROLE(132, stage_residuals, uvec2, "the residuals that the pass starts from")
VOILE_ROLE(133, stage_velocities, vec4, "the velocities that the pass starts from; under Verlet those predicted for the time of the positions")
VOILE_ROLE(134, half_step_velocities, vec4, "Verlet: the velocities, half a substep before the positions")
VOILE_ROLE(135, next_positions, vec4, "the positions that the pass writes")
VOILE_ROLE(136, next_residuals, uvec2, "the residuals that the pass writes")
VOILE_ROLE(137, next_velocities, vec4, "the velocities that the pass writes")
VOILE_ROLE(138, next_predicted, vec4, "Verlet: the velocities predicted for the next substep")
VOILE_ROLE(139, second_velocities, vec4, "RK4: the velocities of stage 2")
VOILE_ROLE(140, third_velocities, vec4, "RK4: the velocities of stage 3")

// The state that a substep proposes, and the state before it. Contact changes the first in place, or writes its result
// into the second.
VOILE_ROLE(141, proposed_positions, vec4, "the positions that integration proposes")
VOILE_ROLE(142, proposed_residuals, uvec2, "the residuals that integration proposes")
VOILE_ROLE(143, proposed_velocities, vec4, "the velocities that integration proposes")
VOILE_ROLE(144, proposed_predicted, vec4, "Verlet: the velocities predicted for the proposed positions")
VOILE_ROLE(145, earlier_positions, vec4, "the positions before the substep; for contact, those at its last pass")
VOILE_ROLE(146, earlier_residuals, uvec2, "the residuals before the substep")
VOILE_ROLE(147, earlier_velocities, vec4, "the velocities before the substep")
VOILE_ROLE(148, earlier_predicted, vec4, "Verlet: the velocities predicted for the earlier positions")
VOILE_ROLE(149, step_votes, uint, "this step's votes for exits")
VOILE_ROLE(150, last_votes, uint, "the last step's votes for exits")
VOILE_ROLE(151, next_votes, uint, "the votes for exits that depenetration writes")

// The strain limit: the states before and after the change that is measured.
VOILE_ROLE(152, step_positions, vec4, "the positions that the strain limit starts from")
VOILE_ROLE(165, step_residuals, uvec2, "the residuals of these positions")
VOILE_ROLE(153, step_velocities, vec4, "the velocities that the strain limit starts from")
VOILE_ROLE(154, before_positions, vec4, "the positions before the change that is measured")
VOILE_ROLE(155, before_residuals, uvec2, "the residuals before the change that is measured")
VOILE_ROLE(156, before_velocities, vec4, "the velocities before the change that is measured")
VOILE_ROLE(157, after_positions, vec4, "the positions after the change that is measured")
VOILE_ROLE(158, after_residuals, uvec2, "the residuals after the change that is measured")
VOILE_ROLE(159, after_velocities, vec4, "the velocities after the change that is measured")
VOILE_ROLE(160, works, LimitWork, "the measured energy and work")
VOILE_ROLE(164, spins, vec4, "the angular velocity of each vertex's neighborhood, and the part of relative velocities that it may take")

// Refit: the hierarchies of cloths, or one of a collider that deforms.
VOILE_ROLE(161, refit_leaves, PaddedLeaf, "the triangles of the hierarchies that are refitted")
VOILE_ROLE(162, refit_positions, vec4, "the vertices of the triangles")
VOILE_ROLE(163, refit_boxes, PaddedBox, "the boxes that a refit writes")

// clang-format on

#undef VOILE_BUFFER
#undef VOILE_SCRATCH_BUFFER
#undef VOILE_OUTPUT_BUFFER
#undef VOILE_SOLVER_BUFFER
#undef VOILE_HOST_BUFFER
#undef VOILE_ROLE
