% Forces, derivatives and contact patches of the wheels of a wheelset that has moved aside: wheel_force.c in Octave.
%
%   octave wheel_force.m TABLE.h5
1;

function print_numbers(name, number)
  printf("%s", name);
  printf(" %.16e", number);
  printf("\n");
end

% Of a wheelset that is 1 mm to the right, turned to the right by 0.5 mrad and moving to the right at 10 mm/s, at the
% height at which this wheel carries 60 kN.
function print_wheel(side)
  z = railtab_mex("height", side, 1e-3, 0, 5e-4, 60e3);
  displacement = [0, 1e-3, z, 0, 0, 5e-4];
  velocity = [0, 0.01, 0, 0, 0, 0];
  velocity_rate = 200;  % of a time step of 10 ms by the trapezoidal rule: 2/h [1/s]
  [force, tangent] = railtab_mex("force", side, displacement, velocity, velocity_rate);
  printf("%s wheel\n", side);
  print_numbers("on the wheelset", force(1:6));
  print_numbers("on the rail", force(7:9));
  for i = 1:9
    print_numbers("derivatives", tangent(i, :));
  end
  patches = railtab_mex("patches", side, displacement);
  for i = 1:rows(patches)
    print_numbers("patch", patches(i, :));
  end
end

arguments = argv();
railtab_mex("open", arguments{1}, 20);
print_wheel("left");
print_wheel("right");
railtab_mex("close");
