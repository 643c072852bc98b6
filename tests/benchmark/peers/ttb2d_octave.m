% A TTB-2D case by TTB-2D's own loop over time steps, which couples the matrices of train, track and bridge anew in every
% step and factors the whole. Prints JSON: processor time per step [ms], and the largest difference of the midspan's
% displacement from the reference's, over the largest displacement.
%
%     octave-cli --norc ttb2d_octave.m TTB2D FOLDER
%
% TTB2D: the sources of TTB-2D, https://github.com/DanielCanteroNTNU/TTB-2D, with B65_DynamicCalcCoupledFaster.m
% FOLDER: of the reference's files
1;

function matrix = read_matrix(file)
  id = fopen(file);
  fgetl(id);  % "%%MatrixMarket matrix coordinate real general"
  sizes = sscanf(fgetl(id), "%d");
  entries = fscanf(id, "%f", [3, Inf])';
  fclose(id);
  matrix = sparse(entries(:, 1), entries(:, 2), entries(:, 3), sizes(1), sizes(2));
end

function values = read_columns(file)
  plain = tempname();
  system(sprintf("gzip -dc '%s' > '%s'", file, plain));
  values = dlmread(plain, ",", 1, 0)(:, 2:end);
  delete(plain);
end

function values = roughness(file, steps, wheels)
  if exist(file, "file")
    values = read_columns(file)';
  else
    values = zeros(wheels, steps);
  end
end

function values = as_cell(values)
  if !iscell(values)
    values = num2cell(values);
  end
end

addpath(argv(){1});
folder = argv(){2};
of_case = jsondecode(fileread(fullfile(folder, "case.json")));
dofs = jsondecode(fileread(fullfile(folder, "dofmap.json")));
ran = of_case.run;
Calc.Solver = struct("num_t", ran.num_t, "dt", ran.dt_s, "NewMark_beta", ran.newmark_beta, ...
                     "NewMark_delta", ran.newmark_gamma);
Calc.Options = struct("disp_every", Inf, "VBI", 1);
Calc.Cte.grav = ran.gravity;
Model.Mesh = struct("Mg", read_matrix(fullfile(folder, "Mg.mtx")), "Cg", read_matrix(fullfile(folder, "Cg.mtx")), ...
                    "Kg", read_matrix(fullfile(folder, "Kg.mtx")));
Model.Mesh.DOF.Tnum = rows(Model.Mesh.Kg);
Model.BC = struct("DOF_fixed", dofs.fixed(:)', "DOF_fixed_value", Model.Mesh.Kg(dofs.fixed(1), dofs.fixed(1)));

rail_x = dofs.rail_x(:)';
elements = numel(rail_x) - 1;
L = rail_x(2) - rail_x(1);
first = dofs.rail_vert(:);  % of each node; its slope follows
Track.Rail.Mesh.Ele = struct("DOF", [first(1:end-1), first(1:end-1) + 1, first(2:end), first(2:end) + 1], ...
                             "a", L * ones(1, elements));
Track.Rail.Mesh.shape_fun = @(x, a) [1 - 3 * (x / a)^2 + 2 * (x / a)^3; x * (1 - x / a)^2; ...
                                     3 * (x / a)^2 - 2 * (x / a)^3; x^2 / a * (x / a - 1)];
Track.Rail.Mesh.shape_fun_p = @(x, a) [6 * (x^2 / a^3 - x / a^2); (1 - x / a) * (1 - 3 * x / a); ...
                                       6 * (x / a^2 - x^2 / a^3); x / a * (3 * x / a - 2)];
Track.Rail.Mesh.shape_fun_pp = @(x, a) [12 * x / a^3 - 6 / a^2; 6 * x / a^2 - 4 / a; ...
                                        6 / a^2 - 12 * x / a^3; 6 * x / a^2 - 2 / a];

cars = as_cell(of_case.Train.Veh);
offsets = ran.axle_offset_from_first_axle_m;
if iscell(offsets)
  offsets = cell2mat(cellfun(@(a) a(:)', offsets(:), "UniformOutput", false));
elseif numel(cars) == 1
  offsets = offsets(:)';
end
rough = {};
names = {"h_m", "hd_mps", "hdd_mps2"};
for i = 1:3
  rough{i} = roughness(fullfile(folder, ["wheel_irregularity_", names{i}, ".csv.gz"]), ran.num_t, 4 * numel(cars));
end
static = ran.static_axle_loads_N;
if iscell(static)
  static = cell2mat(cellfun(@(a) a(:)', static(:), "UniformOutput", false));
end
loads = zeros(Model.Mesh.DOF.Tnum, 1);
loads_of_axles = reshape(static, 4, [])';
if numel(cars) > 1
  loads_of_axles = reshape(static, numel(cars), 4);
end
for i = 1:numel(cars)
  car = cars{i};
  x = offsets(i, :);
  V.Tnum = numel(cars);
  V.Tnum_DOF = 6;
  V.global_ind = 6 * (i - 1) + (1:6);
  V.vel = ran.v_mps;
  V.DOF.vert = [1; 0; 1; 0; 1; 0];
  V.Susp.Prim = car.Susp.Prim;
  V.Wheels = struct("num", 4, "m", car.Wheels.m, "N2w", zeros(4, 6));
  masses = [car.Body.m, car.Body.I, car.Bogie.m(1), car.Bogie.I(1), car.Bogie.m(2), car.Bogie.I(2)];
  V.SysM = struct("M", diag(masses), "C", zeros(6), "K", zeros(6));
  for b = 1:2
    row = zeros(1, 6);
    row([1, 2, 1 + 2 * b]) = [1, (3 - 2 * b) * 0.5 * (x(3) - x(1)), -1];
    V.SysM.K += car.Susp.Sec.k(b) * (row' * row);
    V.SysM.C += car.Susp.Sec.c(b) * (row' * row);
  end
  for w = 1:4
    b = 1 + (w > 2);
    V.Wheels.N2w(w, [1 + 2 * b, 2 + 2 * b]) = [1, (2 * mod(w, 2) - 1) * 0.5 * (x(2) - x(1))];
    row = V.Wheels.N2w(w, :);
    V.SysM.K += car.Susp.Prim.k(w) * (row' * row);
    V.SysM.C += car.Susp.Prim.c(w) * (row' * row);
  end
  Veh(i) = V;
  path = ran.x_first_axle_t0_m - x(:) + ran.v_mps * ran.dt_s * (0:ran.num_t - 1);
  Calc.Veh(i).elexj = min(1 + floor(path / L), elements);
  Calc.Veh(i).xj = path - L * (Calc.Veh(i).elexj - 1);
  own = 4 * (i - 1) + (1:4);
  Calc.Veh(i).h_path = rough{1}(own, :);
  Calc.Veh(i).hd_path = rough{2}(own, :);
  Calc.Veh(i).hdd_path = rough{3}(own, :);
  for w = 1:4
    at = Track.Rail.Mesh.Ele.DOF(Calc.Veh(i).elexj(w, 1), :);
    loads(at) += loads_of_axles(i, w) * Track.Rail.Mesh.shape_fun(Calc.Veh(i).xj(w, 1), L);
  end
end

% Static equilibrium: every axle bears its load.
Sol.Model.Nodal.U0 = Model.Mesh.Kg \ loads;
Sol.Model.Nodal.V0 = Sol.Model.Nodal.A0 = zeros(Model.Mesh.DOF.Tnum, 1);
for i = 1:numel(cars)
  for w = 1:4
    at = Track.Rail.Mesh.Ele.DOF(Calc.Veh(i).elexj(w, 1), :);
    down(w, 1) = Track.Rail.Mesh.shape_fun(Calc.Veh(i).xj(w, 1), L)' * Sol.Model.Nodal.U0(at);
  end
  V = Veh(i);
  Sol.Veh(i).U0 = V.SysM.K \ (V.SysM.M * V.DOF.vert * ran.gravity + V.Wheels.N2w' * (V.Susp.Prim.k .* down));
  Sol.Veh(i).V0 = Sol.Veh(i).A0 = zeros(6, 1);
end

started = cputime();
Sol = B65_DynamicCalcCoupledFaster(Veh, Model, Calc, Track, Sol);
took = cputime() - started;
middle = Sol.Model.Nodal.U(dofs.beam_vert(floor(numel(dofs.beam_vert) / 2) + 1), :)';
reference = read_columns(fullfile(folder, "bridge.csv.gz"))(:, 2);
printf("{\"ms_per_step\": %.6g, \"difference\": %.3g}\n", 1e3 * took / (ran.num_t - 1), ...
       max(abs(middle - reference)) / max(abs(reference)));
