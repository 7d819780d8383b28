# Seeded mistakes: one textual change each to surfaces from files, emitters and sinks, viscosity and
# friction, and free bodies. A test of the quick part must fail: one that does not have the tag
# [slow].
# seeded_defect(NAME TEST FILE OLD NEW): OLD stands in FILE exactly once; TEST is the source whose
# tests are run.

# maps of meshes, beds of given heights
seeded_defect(map_slope_sign tests/unit/program/mesh_map.cpp kernels/shapes/mesh.h
  [[by_slopes + towards[a] *]] [[by_slopes - towards[a] *]])
seeded_defect(map_gradient_sign tests/unit/program/mesh_map.cpp kernels/shapes/mesh.h
  [[* (all * d_value - beside[a] * value)]] [[* (beside[a] * value - all * d_value)]])
seeded_defect(map_gradient_of_slopes_missing tests/unit/program/mesh_map.cpp kernels/shapes/mesh.h
  [[+ towards[a] * slope[a] * (one - Real(2) * s[a]);]] [[;]])
seeded_defect(map_gradient_per_cell tests/unit/program/mesh_map.cpp kernels/shapes/mesh.h
  [[(one / (edge * inv_range))]] [[(one / edge)]])
seeded_defect(map_far_side_swapped tests/unit/program/mesh_map.cpp kernels/shapes/mesh.h
  [[return ((-1 - brick) & 1) == 1;]] [[return ((-1 - brick) & 1) == 0;]])
seeded_defect(map_last_bricks_skipped tests/unit/program/mesh_map.cpp lib/program/mesh_map.cpp
  [[for (int k = by[2][0]; k <= by[2][1]; ++k)]] [[for (int k = by[2][0]; k < by[2][1]; ++k)]])
seeded_defect(map_far_bricks_too_far tests/unit/program/mesh_map.cpp lib/program/mesh_map.cpp
  [[std::max(line[k - away], int(away) - 1)]] [[std::max(line[k - away], int(away) + 1)]])
seeded_defect(map_band_of_range_alone tests/unit/program/mesh_map.cpp lib/program/mesh_map.cpp
  [[band_(std::max(options.range, options.reach) + 2 * kEdge)]] [[band_(options.range)]])
seeded_defect(map_half_range tests/unit/program/mesh_map.cpp lib/program/mesh_map.cpp
  [[if (far < range_ * range_)]] [[if (far < 0.25 * range_ * range_)]])
seeded_defect(map_overlap_counted_twice tests/unit/program/mesh_map.cpp lib/program/mesh_map.cpp
  [[std::clamp(sum.share, 0.0, 1.0)]] [[sum.share]])
seeded_defect(map_inside_as_outside tests/unit/program/mesh_map.cpp lib/program/mesh_map.cpp
  [[winding > 0 ? -nearest : nearest]] [[nearest]])
seeded_defect(map_moment_of_edge_sign tests/unit/program/mesh_map.cpp lib/program/mesh_share.cpp
  [[a < 0 ? -1 : 1, c2]] [[1, c2]])
seeded_defect(bed_covers_x_twice tests/unit/run/surface_files.cpp lib/run/surface_files.cpp
  [[cover_x(g, scene, 1, file);]] [[cover_x(g, scene, 0, file);]])
seeded_defect(bed_without_bottom tests/unit/run/surface_files.cpp lib/run/surface_files.cpp
  [[m.triangle.push_back({middle, first + next, first + k});]] [[]])
seeded_defect(bed_moved_twice tests/unit/run/surface_files.cpp lib/run/surface_files.cpp
  [[x[a] -= translate[a];]] [[x[a] -= 0 * translate[a];]])

# emitters and sinks
seeded_defect(emitter_layer_in_every_substep tests/unit/program/emission.cpp lib/program/emission.cpp
  [[in_update == from ? int(born - plan.born(e, begin)) : 0;]] [[int(born - plan.born(e, begin));]])
seeded_defect(emitter_layer_twice tests/unit/program/emission.cpp lib/program/emission.cpp
  [[now.born = in_update == from ? int(born]] [[now.born = in_update == from ? 1 + int(born]])
seeded_defect(emitter_ids_of_equals tests/unit/program/emission.cpp lib/program/emission.cpp
  [[return t < time || (t == time && o < e);]] [[return t < time;]])
seeded_defect(emitter_id_of_layer_before tests/unit/program/emission.cpp lib/program/emission.cpp
  [[first_id + nozzles[e].columns * layer;]] [[first_id + nozzles[e].columns * (layer - 1);]])
seeded_defect(emitter_offset_missing tests/unit/program/emission.cpp lib/program/emission.cpp
  [[now.front = curve.way(end) - (double(first) + 0.5) * plan.spacing;]]
  [[now.front = curve.way(end) - double(first) * plan.spacing;]])
seeded_defect(emitter_first_layer_late tests/unit/program/emission.cpp lib/program/emission.cpp
  [[time_of((double(layer - layers) + 0.5) * spacing)]]
  [[time_of((double(layer - layers) + 1) * spacing)]])
seeded_defect(emitter_id_reused tests/backend/test_emission.cpp kernels/pass_emit.h
  [[state->next_id += born;]] [[state->next_id += in > 0 ? born - 1 : born;]])
seeded_defect(emitter_layer_not_held tests/backend/test_emission.cpp kernels/emission.h
  [[for (int m = from; m < s.held; ++m)]] [[for (int m = from + 1; m < s.held; ++m)]])
seeded_defect(emitter_ring_for_disc tests/backend/test_emission.cpp kernels/emission.h
  [[n.disc ? a * a + b * b < n]] [[n.disc ? a * a + b * b > n]])
seeded_defect(emitter_work_sign tests/backend/test_emission.cpp kernels/emission.h
  [[0.5 * double(dot(v, v)) - double(dot(gravity, x))]]
  [[0.5 * double(dot(v, v)) + double(dot(gravity, x))]])
seeded_defect(sink_does_not_count tests/backend/test_emission.cpp kernels/pass_emit.h
  [[add_whole(&book.sums[first + k].particles, 1);]] [[]])
seeded_defect(sink_keeps_particle tests/backend/test_emission.cpp kernels/pass_emit.h
  [[id[i] = -1 - mine;]] [[]])
seeded_defect(sink_counts_for_emitter tests/backend/test_emission.cpp lib/program/features/emission.h
  [[        int(c.scene.emitters.size()),
        c.p.gravity,]] [[        0,
        c.p.gravity,]])
seeded_defect(sink_momentum_of_one_axis tests/backend/test_emission.cpp kernels/pass_emit.h
  [[book.add_momentum(first + k, a, double(along[a]));]]
  [[book.add_momentum(first + k, a, double(along[0]));]])

# viscosity and friction
seeded_defect(viscosity_doubled tests/backend/test_viscosity.cpp kernels/pass_xsph.h
  [[(Real(0.5) * p.xsph * p.vol]] [[(p.xsph * p.vol]])
seeded_defect(viscosity_of_one_side tests/backend/test_viscosity.cpp kernels/pass_xsph.h
  [[point<D>(b.x), a.w + b.x.w,]] [[point<D>(b.x), a.w + a.w,]])
seeded_defect(viscosity_of_all_sweeps_in_each tests/backend/test_viscosity.cpp lib/scene/viscosity.cpp
  [[*s.viscosity->kinematic) / sweeps;]] [[*s.viscosity->kinematic);]])
seeded_defect(friction_doubled tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[friction * strength * first_moment]] [[Real(2) * friction * strength * first_moment]])
seeded_defect(friction_without_its_key tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[friction * strength * first_moment]] [[strength * first_moment]])
seeded_defect(friction_of_lower_walls_alone tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[for (int wall = 0; wall < 6; ++wall) {]] [[for (int wall = 0; wall < 6; wall += 2) {]])
seeded_defect(friction_along_normal tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[slip - dot(slip, normal) * normal]] [[slip]])
seeded_defect(friction_in_frame_of_domain tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[solid_velocity ? velocity_at(solid_velocity[k], x) : Vec3<Real>{};]] [[{};]])
seeded_defect(friction_of_turning_missing tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[u + cross(omega, at);]] [[u + 0.0 * cross(omega, at);]])
seeded_defect(friction_load_missing tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[if (booked) solid_scene->loads.add(surface, i, x, p.dt * (now - v));]] [[]])
seeded_defect(friction_load_sign tests/backend/test_viscosity.cpp kernels/pass_friction.h
  [[p.dt * (now - v)]] [[p.dt * (v - now)]])
seeded_defect(friction_energy_of_domain tests/backend/test_dissipation.cpp kernels/pass_friction.h
  [[energy_taken(slip, now - u);]] [[energy_taken(v, now);]])
seeded_defect(friction_in_first_sweep_alone tests/backend/test_viscosity.cpp
  lib/program/features/viscosity.h
  [[if (has_friction(s)) b.after(Friction());]] [[if (k == 0 && has_friction(s)) b.after(Friction());]])

# free bodies
seeded_defect(body_turns_backwards tests/backend/test_free_bodies.cpp kernels/boundary/free_body.h
  [[const Vec3<double> next = q + half *]] [[const Vec3<double> next = q - half *]])
seeded_defect(body_inertia_does_not_turn tests/backend/test_free_bodies.cpp
  kernels/boundary/free_body.h
  [[dot(vec(half[i]), vec(turn.row[k]));]] [[b.inertia[i][k];]])
seeded_defect(body_takes_half tests/backend/test_free_bodies.cpp kernels/boundary/free_body.h
  [[velocity_by(inverse, part * owed)]] [[velocity_by(inverse, 0.5 * part * owed)]])
seeded_defect(body_does_not_give_way tests/backend/test_free_bodies.cpp kernels/pass_lambda.h
  [[denominator += boundary]] [[denominator += Real(0) * boundary]])
seeded_defect(body_stops_particles_at_once tests/backend/test_free_bodies.cpp kernels/boundary/solid_scene.h
  [[(squared + b.among.stopped * ease]] [[(squared + 0.0 * ease]])
seeded_defect(body_moment_about_corner tests/backend/test_free_bodies.cpp kernels/pass_bodies.h
  [[(vec(moment) - cross(vec(s.at.center), vec(way)))]] [[vec(moment)]])
seeded_defect(body_sums_counted_twice tests/backend/test_free_bodies.cpp kernels/pass_bodies.h
  [[now.seen = all;]] [[]])
seeded_defect(body_sums_seen_too_long tests/backend/test_free_bodies.cpp kernels/pass_bodies.h
  [[rows.step[b].seen = {};]] [[]])
seeded_defect(body_lock_of_turns_missing tests/backend/test_free_bodies.cpp lib/program/body_kinds.cpp
  [[o.free->locks(kLockNames[3 + row]);]] [[false;]])
seeded_defect(body_gravity_of_half_a_step tests/backend/test_free_bodies.cpp kernels/pass_bodies.h
  [[vec(s.velocity) + rows.dt * gravity]] [[vec(s.velocity) + 0.5 * rows.dt * gravity]])
seeded_defect(body_solid_left_behind tests/backend/test_free_bodies.cpp kernels/pass_bodies.h
  [[static_cast<BodyFrame<Real>&>(placed[k].solid) = frame;]] [[]])
seeded_defect(contact_without_radius tests/backend/test_free_bodies.cpp
  kernels/boundary/body_contact.h
  [[: at[wall / 2]) - radius;]] [[: at[wall / 2]);]])
seeded_defect(contact_of_upper_walls_alone tests/backend/test_free_bodies.cpp
  kernels/boundary/body_contact.h
  [[c.normal[wall / 2] = wall % 2 ? -1 : 1;]] [[c.normal[wall / 2] = -1;]])
seeded_defect(contact_pushes_one_of_two tests/backend/test_free_bodies.cpp
  kernels/boundary/body_contact.h
  [[if (k >= 0) push(k, other_arm, -more * n);]] [[]])
seeded_defect(contact_pulls tests/backend/test_free_bodies.cpp kernels/boundary/body_contact.h
  [[max2(c.impulse + (allowed - speed) / ease, 0.0)]] [[(c.impulse + (allowed - speed) / ease)]])
seeded_defect(contact_without_turn tests/backend/test_free_bodies.cpp
  kernels/boundary/body_contact.h
  [[without(body[b].kept, cross(arm, impulse))]] [[without(body[b].kept, 0.0 * cross(arm, impulse))]])
seeded_defect(body_mass_center_of_shape tests/unit/program/body_mass.cpp lib/program/body_mass.cpp
  [[out.center + m.center[k] * rows[k];]] [[out.center + 0 * m.center[k] * rows[k];]])
seeded_defect(body_inertia_not_along_scene tests/unit/program/body_mass.cpp
  lib/program/body_mass.cpp
  [[rows[i][a] * in_body[i][j] * rows[j][b];]]
  [[rows[a][i] * in_body[i][j] * rows[b][j];]])
seeded_defect(body_inertia_without_trace tests/unit/program/body_mass.cpp lib/program/body_mass.cpp
  [[(i == j ? trace : 0) - second]] [[(i == j ? trace : 1) - second]])
