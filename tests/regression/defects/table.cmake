# The seeded defects: one textual change each to a copy of the physics or of the CPU backend, from
# which a second CPU solver is compiled beside the right one (configure with -DPBF_DEFECT=NAME).
# seeded_defect(NAME STAGE FILE OLD NEW [SCENE]): OLD stands in FILE exactly once; STAGE is where
# `pbf compare` should find it, "none" for a change that only rounds differently and must raise no
# alarm; SCENE.yaml lies here, without one it is scene.yaml.

# predict
seeded_defect(gravity_twice predict kernels/pass_predict.h
  [[v, p.dt * p.gravity]] [[v, (p.dt + p.dt) * p.gravity]])
seeded_defect(wrong_dt predict kernels/pass_predict.h
  [[mul_add(p.dt, v, x)]] [[mul_add(Real(1.001) * p.dt, v, x)]])
seeded_defect(damping_ignored predict kernels/pass_predict.h
  [[mul_add(p.damping, v,]] [[mul_add(Real(1), v,]])
seeded_defect(predict_clamp_dropped predict kernels/pass_predict.h
  [[const auto [end, still] = path_end(x, free);]]
  [[const Vec3<Real> end = free, still{};]])

# grid
seeded_defect(stale_bins grid kernels/pass_predict.h
  [[bin[i] = bin_of<D>(xyz(position[i]), p);]]
  [[bin[i] = bin_of<D>(Real(0.99) * xyz(position[i]), p);]])
seeded_defect(gather_wrong_order grid kernels/pass_predict.h
  [[velocity_out[to] = with_w(m.v, Real(0));]] [[velocity_out[to] = with_w(xyz(velocity[to]), Real(0));]])

# neighbors
seeded_defect(missing_neighbor_cell neighbors kernels/cell_index.h
  [[: y + 1 < p.cells_y ? y + 1 : p.cells_y - 1;]] [[: y;]])
seeded_defect(last_cell_off_by_one neighbors kernels/cell_index.h
  [[x_high + 2 < p.cells_x ? x_high + 2 : p.cells_x - 1;]]
  [[x_high + 2 < p.cells_x ? x_high + 2 : p.cells_x - 2;]])
seeded_defect(stale_grid neighbors lib/solver/step_context.h
  [[exec.build_lists(of, capacity(), position(),]]
  [[exec.build_lists(of, capacity(), data(other<field::position>),]])
seeded_defect(last_neighbor_skipped neighbors lib/exec/cpu/list_maker.h
  [[close_to<D>(simd, columns, blocks, x, i + l, out) - out);]]
  [[std::max<std::ptrdiff_t>(close_to<D>(simd, columns, blocks, x, i + l, out) - out, 1) - 1);]])
seeded_defect(short_cutoff neighbors lib/exec/cpu/close_pairs.h
  [[kCutoffSquared = 1;]] [[kCutoffSquared = 0.98f;]])

# density
seeded_defect(kernel_constant density kernels/smoothing.h
  [[norm = Real((dimensions == 2 ? 10.0 : 15.0) / kPi)]] [[norm = Real(15.1 / kPi)]])
seeded_defect(self_term_missing density kernels/pass_lambda.h
  [[rho = p.vol * density_norm<Real, S>() * (Real(1) + s.shape)]]
  [[rho = p.vol * density_norm<Real, S>() * s.shape]])
seeded_defect(wrong_mass density lib/solver/params.h
  [[p.vol = Real(plan.vol);]] [[p.vol = Real(1.001 * plan.vol);]])
seeded_defect(wall_density_missing density kernels/pass_lambda.h
  [[(Real(1) + s.shape) + wall.density;]] [[(Real(1) + s.shape);]])
seeded_defect(float_for_double density kernels/pass_lambda.h
  [[(Real(1) + s.shape) + wall.density;
      set_row(density, i, rho);]]
  [[[](auto x) {
              const auto high = Real(sizeof(Real) == 8 ? 0x20000001 : 0) * x;
              return high - (high - x);  // 24 bits
            }(Real(1) + s.shape) +
            wall.density;
      set_row(density, i, rho);]])

# lambda
seeded_defect(lambda_sign lambda kernels/pass_lambda.h
  [[, -c / (]] [[, c / (]])
seeded_defect(relaxation_missing lambda kernels/pass_lambda.h
  [[dot(own_gradient, own_gradient) + p.cfm;]] [[dot(own_gradient, own_gradient);]])
seeded_defect(wall_gradient_missing lambda kernels/pass_lambda.h
  [[in_space(s.gradient) + wall.gradient;]] [[in_space(s.gradient);]])
seeded_defect(wall_gradient_side lambda kernels/boundary/box.h
  [[(side == 0 ? g.slope : -g.slope)]] [[g.slope]])
seeded_defect(two_sided_by_mistake lambda kernels/pass_lambda.h
  [[return p.two_sided ? c : choose(c < Real(0), V(0), c);]] [[return c;]])

# delta
seeded_defect(s_corr_sign delta kernels/pass_delta.h [[w -= p.tensile_k]] [[w += p.tensile_k]])
seeded_defect(frozen_particle delta kernels/pass_delta.h
  [[set_row(position_out, i, with_w(inside, inverse_density));]]
  [[set_row(position_out, i, with_w(inside, inverse_density));
    if constexpr (is_one<V>) {
      if (i == 7) position_out[7] = with_w(x, position_out[7].w);
    } else if (const int l = 7 - i[0]; l >= 0 && l < V::width) {
      position_out[7] = {x.x.v[l], x.y.v[l], x.z.v[l], position_out[7].w};
    }]])
seeded_defect(wall_clamp_dropped delta kernels/pass_delta.h
  [[      end.x = boundary.path_end(x, target);]] [[      end.x = target;]])
seeded_defect(velocity_not_updated delta kernels/pass_delta.h
  [[xyz(row(velocity, i)) + p.inv_dt * (move + (inside - target))]]
  [[xyz(row(velocity, i))]])
seeded_defect(neighbors_lambda_missing delta kernels/pass_delta.h
  [[V w = x.w + y.w;]] [[V w = x.w + x.w;]])
seeded_defect(s_corr_exponent delta kernels/pass_delta.h
  [[x = x * x;
    return x * x;]] [[return x * x;]])
seeded_defect(inverse_density_missing delta kernels/pass_delta.h
  [[inverse_density = Real(1) / row(density, i);]] [[inverse_density = V(1);]])
seeded_defect(one_iteration_less iterations lib/solver/stepper.h
  [[for (int k = 0; k < s.times; ++k) {]] [[for (int k = 0; k + 1 < s.times; ++k) {]])

# levels, in the scene levels.yaml
seeded_defect(level_cell_of_next levels kernels/pass_level_cells.h
  [[home[i] = in ? c : -1;]] [[home[i] = in ? (c + 1) % grid.size() : -1;]] levels)
seeded_defect(level_last_row_left_out levels kernels/pass_level_cells.h
  [[cell[axis] + 1 < grid.cells[axis] ? 2 : 3; };]] [[2; };]] levels)
seeded_defect(level_node_beside_air levels kernels/pass_level_cells.h
  [[inside < grid.half(cell) ||]] [[inside == 0 ||]] levels)
seeded_defect(level_open_face_opposite levels kernels/pass_level_cells.h
  [[~(closed >> 2 * k)]] [[~((closed >> 2 * k & 1) * 3)]] levels)
seeded_defect(level_coarser_node_on levels kernels/pass_level_cells.h
  [[sum.bits |= value;]] [[sum.bits |= weight < 1 << 18 ? 0 : value;]] levels)
seeded_defect(level_stiffness levels kernels/pass_level_cells.h
  [[coarser < l; ++coarser) s *= 4;]] [[coarser < l; ++coarser) s *= 2;]] levels)
seeded_defect(level_coarse_weights levels kernels/levels.h
  [[* slope >> 24);]] [[* (slope & 0u) >> 24);]] levels)
seeded_defect(level_walls_not_upward levels kernels/pass_level_cells.h
  [[walls[n] = on ? against : 0;]] [[walls[n] = on && l == 0 ? against : 0;]] levels)
seeded_defect(level_walls_not_downward levels kernels/pass_level_cells.h
  [[min2((end[k] - 1) / 2 + 2, last)]] [[min2((end[k] - 1) / 2 + 1, last)]] levels)
seeded_defect(level_clip_missing levels kernels/pass_levels.h
  [[max2(min2(rho - Real(1), Real(kLevelClip)), Real(-1))]]
  [[max2(rho - Real(1), Real(-1))]] levels)
seeded_defect(level_sum_one_sided levels kernels/pass_levels.h
  [[Real(kLevelClip)), Real(-1))]] [[Real(kLevelClip)), Real(0))]] levels)
seeded_defect(level_beyond_face_counted levels kernels/pass_levels.h
  [[(!home || home[j] >= 0) ?]] [[true ?]] levels)
seeded_defect(level_cell_left_out levels kernels/levels.h
  [[x < end[0]; x += 1 << bits)]] [[x + 1 < end[0]; x += 1 << bits)]] levels)
seeded_defect(level_multiplier_signed levels kernels/pass_levels.h
  [[sum_here > 0 ? answer]] [[sum_here != 0 ? answer]] levels)
seeded_defect(level_from_one_coarse_node levels kernels/pass_levels.h
  [[(Real(at[k] - (low[k] << l)) + Real(0.5)) * cell;]]
  [[l == 0 ? Real(0.5) : Real(0);]] levels)
seeded_defect(level_last_cell_as_long levels kernels/pass_level_cells.h
  [[at[k] + 1 == grid.cells[k] ? by_last[k] : by_edge]] [[by_edge]] levels)
seeded_defect(level_momentum_missing levels kernels/pass_level_cells.h
  [[3 ? 1 : at_rest;]] [[3 ? 1 : 1;]] levels)
seeded_defect(level_momentum_at_walls levels kernels/pass_level_cells.h
  [[found >> 2 * k & 3 ? 1]] [[found > 64 ? 1]] levels)
seeded_defect(level_displacement_sign delta kernels/pass_delta.h
  [[all + coarse(i);]] [[all - coarse(i);]] levels)

# xsph, vorticity
seeded_defect(xsph_without_density xsph kernels/pass_xsph.h [[a.w + b.x.w,]] [[V(2),]])
seeded_defect(xsph_sign xsph kernels/pass_xsph.h [[point<D>(b.v) - a.v);]] [[a.v - point<D>(b.v));]])
seeded_defect(curl_sign vorticity kernels/pass_vorticity.h
  [[root.inverse) * d, v);]] [[root.inverse) * d, a.v - point<D>(b.v));]])
seeded_defect(vorticity_sign vorticity kernels/pass_vorticity.h
  [[+ (Real(1) - p.carry) / size * push]] [[- (Real(1) - p.carry) / size * push]])
seeded_defect(vorticity_at_surface vorticity kernels/pass_vorticity.h
  [[a.x.w > Real(1)]] [[a.x.w * Real(0.5) > Real(1)]])
seeded_defect(vorticity_unbounded vorticity kernels/pass_vorticity.h
  [[min2(p.vorticity, Real(2) * square_root(s.approach))]] [[p.vorticity]])

# obstacles, loads and gauges, in the scene solids.yaml; the motion of the tank in tank.yaml
seeded_defect(solid_slab_sign density kernels/boundary/solid_share.h
  [[return {near.density - far.density,]] [[return {near.density + far.density,]] solids)
seeded_defect(solid_slab_slope_sign lambda kernels/boundary/solid_share.h
  [[up ? slope : -slope};]] [[up ? -slope : slope};]] solids)
seeded_defect(solid_bend_missing density kernels/boundary/solid_share.h
  [[k = flat ? bend : Real(0.5) + Real(0.5) * bend,]] [[k = flat ? bend : Real(0.5) * bend,]] solids)
seeded_defect(solid_ball_slope_sign lambda kernels/shapes/sphere.h
  [[{g.density, (g.slope * at.inverse) * at.away}]] [[{g.density, (-g.slope * at.inverse) * at.away}]] solids)
seeded_defect(solid_gradient_not_turned lambda kernels/boundary/solid_term.h
  [[inv_range * turned_back<D>(o, w.gradient);]] [[inv_range * w.gradient;]] solids)
seeded_defect(solid_beside_wall_added density kernels/boundary/solid_scene.h
  [[w.density = s.walls.scale - left * free;]]
  [[w.density = w.density + s.walls.scale * o.share;]] solids)
seeded_defect(solid_turn_transposed predict lib/program/posed_solids.h
  [[out.solid.turn[axis][k] = Real(s.turn[axis][k]);]]
  [[out.solid.turn[axis][k] = Real(s.turn[k][axis]);]] solids)
seeded_defect(solid_reach_zero density lib/program/posed_solids.h
  [[out.reach = Real(range);]] [[out.reach = Real(0);]] solids)
seeded_defect(solid_velocity_missing predict kernels/boundary/solid_scene.h
  [[start && s.before ? s.before[k] : placed.solid;]] [[placed.solid;]] solids)
seeded_defect(solid_pose_of_next_step predict lib/solver/step_solver.h
  [[{at(done) * n, steps * n,]]
  [[{at(done) * n + 1, steps * n,]] solids)
seeded_defect(load_of_clamp_missing loads kernels/boundary/solid_scene.h
  [[      move_by(load_row_of_solid(k), out.given);]] [[]] solids)
seeded_defect(load_of_walls_share loads kernels/boundary/solid_scene.h
  [[book_on(s, k, i, x, (factor * left) * one.gradient, false);]]
  [[book_on(s, k, i, x, factor * one.gradient, false);]] solids)
seeded_defect(load_of_far_rows loads lib/program/posed_solids.h
  [[reach = Real(1) / walls.inv_range + walls.margin + Real(kNearRoom),]]
  [[reach = Real(0.5) / walls.inv_range + walls.margin,]] solids)
seeded_defect(load_moment_sign loads kernels/boundary/loads.h
  [[cross(x, way);]] [[cross(way, x);]] solids)
seeded_defect(load_moment_of_moving loads kernels/boundary/loads.h
  [[v.middle[b] * impulse[c] - v.middle[c] * impulse[b];]] [[v.middle[b] * impulse[c];]] solids)
seeded_defect(load_part_left_out loads kernels/boundary/loads.h
  [[for (int part = 0; part < kLoadParts; ++part) {]]
  [[for (int part = 1; part < kLoadParts; ++part) {]] solids)
seeded_defect(patch_too_small gauges kernels/boundary/patch.h
  [[most = p.radius + p.soft;]] [[most = p.radius;]] solids)
seeded_defect(flow_one_way gauges kernels/pass_flow.h
  [[now >> k & 1 ? 1 : -1;]] [[now >> k & 1 ? 1 : 0;]] solids)
seeded_defect(flow_beside_gate gauges kernels/pass_flow.h
  [[|| !within(gate[k], x)) continue;]] [[) continue;]] solids)
seeded_defect(level_gauge_weight gauges kernels/gauge_probe.h
  [[add(p, p.first + n, i, t * t * t);]] [[add(p, p.first + n, i, t * t);]] solids)
seeded_defect(velocity_gauge_axis gauges kernels/gauge_probe.h
  [[bounded(update_dt * double(v.z))]] [[bounded(update_dt * double(v.y))]] solids)
seeded_defect(tank_coriolis_sign predict lib/program/obstacle_motion.h
  [[out.turn[i][j] = Real(f.turn[i][j])]] [[out.turn[i][j] = Real(-f.turn[i][j])]] tank)
seeded_defect(tank_euler_missing predict lib/program/obstacle_motion.h
  [[out.pull[i][j] = Real(f.pull[i][j]);]]
  [[out.pull[i][j] = Real((f.pull[i][j] + f.pull[j][i]) / 2);]] tank)
seeded_defect(tank_pivot_missing predict lib/program/obstacle_motion.h
  [[out.pivot = scaled<Real>(f.pivot, 1);]] [[out.pivot = {};]] tank)

# second order in time
seeded_defect(second_directions_ahead delta kernels/pass_lambda.h
  [[place = place - p.back * xyz(load(velocity, i))]]
  [[place = place + p.back * xyz(load(velocity, i))]] second)
seeded_defect(second_kick_of_wrong_step predict kernels/pass_predict.h
  [[with_w(m.v - push, Real(0))]] [[with_w(m.v, Real(0))]] second)
seeded_defect(second_push_taken_whole predict kernels/pass_predict.h
  [[? p.carry * push : push;]] [[? push : push;]] second)
seeded_defect(second_half_step_at_resume predict kernels/pass_change_step.h
  [[const Real old = Real(last->dt), half(0.5);]] [[const Real old(0), half(0.5);]] second)
seeded_defect(second_walls_at_y delta kernels/time_order.h
  [[choose(left > Real(0), x - left * w, x);]] [[x - w;]] second)
seeded_defect(second_walls_at_x delta kernels/time_order.h
  [[choose(left > Real(0), x - left * w, x);]] [[x;]] second)
seeded_defect(second_load_not_carried loads kernels/boundary/loads.h
  [[to.way[k] += whole(carry * way);]] [[]] second_solids)

# Other arithmetic, as another backend may have it.
seeded_defect(clean_reverse_sums none kernels/lane_groups.h
  [[pass.lists.group(i);
  for (int left = pass.lists.rounds(i); left > 0; --left, entry += W)]]
  [[pass.lists.group(i) + pass.lists.rounds(i) * W;
  for (int left = pass.lists.rounds(i); left > 0 && (entry -= W); --left)]])
seeded_defect(clean_reciprocal_root none kernels/vec3.h
  [[const Real q = square_root(q_squared);
  return {q, Real(1) / q};]]
  [[const Real inverse = Real(1) / square_root(q_squared);
  return {q_squared * inverse, inverse};]])
seeded_defect(clean_unfused_division none kernels/pass_lambda.h
  [[-c / (under_relaxation(rho, p) * denominator)]]
  [[-c * (Real(1) / (under_relaxation(rho, p) * denominator))]])
