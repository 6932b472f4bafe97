% Another code, in GNU Octave: the material point method with quadratic B-splines on the small bar.
%
%     octave-cli golden/examples/bspline_mpm.m mine.csv
%     hompm-diff --relative all=1e-2 --exact all=2e-2 mine.csv golden/bar-small-bspline
%
% The time step is ten times that of the golden data, so the two differ by what the step does. Writes
% positions, velocity and stress at the times of the golden data, then reads those and compares itself. Needs
% Octave (Debian package octave) and nothing of hompm.
1;  % a script, not a file of functions

function [N, dN] = basis(x, h, cells)
  % Values and derivatives of the functions (columns) at the particles (rows), open uniform knot vector.
  cell = min(floor(x / h), cells - 1);
  s = x / h - cell;
  value = [(1 - s).^2 / 2, (1 + 2*s - 2*s.^2) / 2, s.^2 / 2];
  slope = [s - 1, 1 - 2*s, s] / h;
  first = cell == 0;  % repeated knots at the ends
  last = cell == cells - 1;
  value(first, 1:2) += value(first, 1) * [1, -1];
  slope(first, 1:2) += slope(first, 1) * [1, -1];
  value(last, 2:3) += value(last, 3) * [-1, 1];
  slope(last, 2:3) += slope(last, 3) * [-1, 1];
  row = repmat((1:numel(x))', 1, 3);
  column = cell + [1, 2, 3];
  N = sparse(row, column, value, numel(x), cells + 2);
  dN = sparse(row, column, slope, numel(x), cells + 2);
end

% golden/bar-small-bspline/scene.toml, but for dt
L = 25; rho = 1; E = 100; amplitude = 0.1; end_time = 2.5;
cells = 64; per_cell = 4; dt = 1e-3;
h = L / cells;

X = ((1:cells * per_cell)' - 0.5) * h / per_cell;
V0 = h / per_cell;
m = rho * V0 * ones(size(X));
u = stress = zeros(size(X));
stretch = ones(size(X));
v = amplitude * sin(pi * X / L);

steps = round(end_time / dt);
results = [0 * X, X, X + u, v, stress];
for number = 1:steps
  [N, dN] = basis(X + u, h, cells);
  mass = N' * m;
  a = -(dN' * (V0 * stretch .* stress)) ./ mass;
  a([1, end]) = 0;  % fixed ends
  v += dt * (N * a);
  grid_v = (N' * (m .* v)) ./ mass;
  grid_v([1, end]) = 0;
  strain = dt * (dN * grid_v);
  u += dt * (N * grid_v);
  stress += (E - stress) .* strain;  % the law `rate`
  stretch .*= 1 + strain;
  if any(number == [steps / 2, steps])
    results = [results; number * dt + 0 * X, X, X + u, v, stress];
  end
end

name = argv(){end};
file = fopen(name, "w");
fprintf(file, "time,X,x,velocity,stress\n");
fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.17g\n", results');
fclose(file);

% The golden data as Octave sees them: the rows are in the order of time and X, as ours are.
golden = fullfile(fileparts(mfilename("fullpath")), "..", "bar-small-bspline");
particles = dlmread(fullfile(golden, "particles.csv"), ",", 1, 0);  % time,particle,X,x,displacement,velocity,...
stresses = dlmread(fullfile(golden, "stress.csv"), ",", 1, 0);      % time,particle,X,x,stress,stretch
distance = @(mine, theirs) max(abs(mine - theirs)) / max(abs(theirs));
printf("x: largest distance %.1e of the largest value\n", distance(results(:, 3), particles(:, 4)));
printf("velocity: largest distance %.1e of the largest value\n", distance(results(:, 4), particles(:, 6)));
printf("stress: largest distance %.1e of the largest value\n", distance(results(:, 5), stresses(:, 5)));
