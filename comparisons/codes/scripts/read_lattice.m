function read_lattice(folder, steps)
  % A lattice that `sheetbench ... --export DIR` wrote, in MATLAB or Octave: force, statics by Newton.
  %
  %   octave --quiet --eval "read_lattice('DIR')"        steps of the load: 1 unless given, more where needed
  if nargin < 1, error('usage: read_lattice(''DIR'', steps)'); end
  if nargin < 2, steps = 1; end
  lattice = load([folder '/lattice.mat']);
  if ~isempty(lattice.pressure) || ~isempty(lattice.couple_moment), error('dead loads only'); end
  if ~isempty(lattice.contact_values), error('this reader knows no obstacles'); end
  along = differences(lattice);
  largest = 0;
  for state = 1:numel(lattice.state_energy)
    truth = squeeze(lattice.state_displacement(state, :, :));
    force = squeeze(lattice.state_force(state, :, :));
    largest = max(largest, norm(gradient_of(lattice, along, truth) - force, inf) / norm(force, inf));
  end
  off = norm(equilibrium(lattice, along, steps) - truth, inf) / norm(truth, inf);
  fprintf('forces of %d states off by %.1e, displacements at rest by %.1e\n', state, largest, off);
  if ~(largest < 1e-9), error('this is not the lattice of the folder'); end
  if ~(off < 1e-6), error('another equilibrium than the folder''s: try more steps'); end
end

function along = differences(lattice)
  % Matrices that take positions (n, 3) to the vectors that springs see: along links, across cells.
  of = speye(size(lattice.positions, 1));
  ends = double(lattice.link_masses) + 1;  % numbers count from 0 in the file
  along.link = of(ends(:, 2), :) - of(ends(:, 1), :);
  for kind = {'area', 'strain', 'coupling', 'rubber', 'face'}
    corners = double(lattice.([kind{1} '_corners'])) + 1;
    [first, second, warp, p] = deal(0, 0, 0, size(corners, 3));
    for mass = 1:p  % a corner is the mean of one mass or several
      at = @(corner) of(corners(:, corner, mass), :) / p;
      [first, second] = deal(first + at(3) - at(1), second + at(4) - at(2));
      warp = warp + at(1) - at(2) + at(3) - at(4);
    end
    along.(kind{1}) = {first, second, (first - second) / 2, (first + second) / 2, warp};
  end
end

function g = gradient_of(lattice, along, u)
  % Gradient (n, 3) [N] of the energy of all springs at displacements u (n, 3) [m].
  [rest, x] = deal(lattice.positions, lattice.positions + u);
  r = along.link * x;
  g = along.link' * (lattice.link_stiffness .* (1 - lattice.link_rest_length ./ sqrt(sum(r .^ 2, 2))) .* r);

  [d1, d2] = deal(along.area{1} * x, along.area{2} * x);
  c = cross(d1, d2, 2);
  turned = 0.5 * lattice.area_stiffness .* (0.5 ./ lattice.area_rest - 1 ./ sqrt(sum(c .^ 2, 2))) .* c;
  g = g + along.area{1}' * cross(d2, turned, 2) + along.area{2}' * cross(turned, d1, 2);

  for kind = {'strain', 'coupling'}
    k = lattice.([kind{1} '_stiffness']);
    if isempty(k), continue; end
    [over_a, over_b, a0] = deal(along.(kind{1}){3:4}, lattice.([kind{1} '_rest']));
    free = lattice.([kind{1} '_natural']);  % what sides have without stress
    [a, b, aa, bb] = deal(over_a * x, over_b * x, free(:, 1), free(:, 2));
    e = [(sum(a .^ 2, 2) ./ aa - 1) / 2, (sum(b .^ 2, 2) ./ bb - 1) / 2, (sum(a .* b, 2) - free(:, 3)) ./ a0];
    t = k .* e;
    if strcmp(kind{1}, 'coupling'), t = k(:, [1 1 2]) .* e(:, [2 1 1]) + k(:, [2 3 3]) .* e(:, [3 3 2]); end
    g = g + over_a' * (t(:, 1) .* a0 ./ aa .* a + t(:, 3) .* b);
    g = g + over_b' * (t(:, 2) .* a0 ./ bb .* b + t(:, 3) .* a);
  end
  if ~isempty(lattice.rubber_rest), g = g + of_rubber(lattice, along, rest, x); end
end

function g = of_rubber(lattice, along, rest, x)
  % Gradient (n, 3) [N] of the energy of rubber membranes and upright faces at places x (n, 3) [m].
  [over_a, over_b, warp, a0] = deal(along.rubber{3:5}, lattice.rubber_rest);
  [a, b, aa, bb] = deal(over_a * x, over_b * x, sum((over_a * rest) .^ 2, 2), sum((over_b * rest) .^ 2, 2));
  k = num2cell(lattice.rubber_stiffness, 1);
  [c10, c01, c20, c30, v, limit, ka, kb] = deal(k{:});
  limit(limit == 0) = Inf;
  q = warp * x;
  [c11, c22] = deal((sum(a .^ 2, 2) + sum(q .^ 2, 2) / 12) ./ aa, (sum(b .^ 2, 2) + sum(q .^ 2, 2) / 12) ./ bb);
  [c12, trace_c] = deal(sum(a .* b, 2) ./ a0, c11 + c22);
  area = c11 .* c22 - c12 .^ 2;
  log_theta = -v ./ (v + 4 * (c10 + c01)) .* log(area);
  for iteration = 1:50  % Newton's method for the thickness
    [theta, i] = deal(exp(log_theta), trace_c + exp(log_theta) - 3);
    f1 = c10 ./ (1 - i ./ limit) + 2 * c20 .* i + 3 * c30 .* i .^ 2;
    f2 = c10 ./ limit ./ (1 - i ./ limit) .^ 2 + 2 * c20 + 6 * c30 .* i;
    pulled = theta .* (f1 + c01 .* trace_c);
    miss = pulled - c10 - 2 * c01 + v / 4 .* log(area .* theta);
    log_theta = log_theta - miss ./ (pulled + theta .^ 2 .* f2 + v / 4);
  end
  pa = ka .* (1 - sqrt(aa ./ (sum(a .^ 2, 2) + sum(q .^ 2, 2) / 4)));
  pb = kb .* (1 - sqrt(bb ./ (sum(b .^ 2, 2) + sum(q .^ 2, 2) / 4)));
  [by_trace, by_area] = deal(f1 + c01 .* theta, c01 - pulled ./ area);
  s = 2 * a0 .* (by_trace + by_area .* c22) ./ aa;
  t = 2 * a0 .* (by_trace + by_area .* c11) ./ bb;
  both = -2 * by_area .* c12;
  g = over_a' * ((s - pa) .* a + both .* b) + over_b' * ((t - pb) .* b + both .* a);
  g = g + warp' * (((s + t) / 12 - (pa + pb) / 4) .* q);

  [over_a, over_b, k, a0] = deal(along.face{3:4}, lattice.face_stiffness, lattice.face_rest);
  [a, b, aa] = deal(over_a * x, over_b * x, sum((over_a * x) .^ 2, 2));
  sheared = k .* a0 .* sum(a .* b, 2) ./ (aa .* sum((over_b * rest) .^ 2, 2));
  g = g + over_a' * (sheared .* (b - sum(a .* b, 2) ./ aa .* a)) + over_b' * (sheared .* a);
end

function u = equilibrium(lattice, along, steps)
  % Displacements (n, 3) at rest: Newton, the tangent by differences, supports by multipliers.
  [n, holds, p] = deal(size(lattice.positions, 1), numel(lattice.hold_axis), size(lattice.hold_masses, 2));
  places = double(lattice.hold_axis) * n + double(lattice.hold_masses) + 1;
  held = sparse(repmat((1:holds)', 1, p), places, 1 / p, holds, 3 * n);
  fprintf('statics of %d masses, load in %d step(s)\n', n, steps);
  [u, push, h] = deal(zeros(3 * n, 1), zeros(holds, 1), 1e-7 * max(lattice.link_rest_length));
  force_at = @(u) reshape(gradient_of(lattice, along, reshape(u, n, 3)), [], 1);
  for part = (1:steps) / steps
    for iteration = 1:20
      [force, tangent, shift] = deal(force_at(u), zeros(3 * n), h * eye(3 * n));
      for column = 1:3 * n, tangent(:, column) = (force_at(u + shift(:, column)) - force) / h; end
      unbalanced = part * lattice.load(:) - force - held' * push;
      missing = part * lattice.hold_displacement - held * u;
      step = [tangent, held'; held, zeros(holds)] \ [unbalanced; missing];
      [u, push] = deal(u + step(1:3 * n), push + step(3 * n + 1:end));
      moved = norm(step(1:3 * n), inf) / max(norm(u, inf), realmin);
      if ~(moved > 1e-9 && moved < 1e3), break; end
    end
    if ~(moved <= 1e-9)  % Newton did not converge: the load comes in twice as many steps
      if steps >= 64, error('no equilibrium found in %d steps of the load: try more', steps); end
      u = equilibrium(lattice, along, 2 * steps);
      return
    end
  end
  u = reshape(u, n, 3);
end
