! railtab/contact.h for Fortran: derived types and functions under their C names. Units, signs and errors are those of the
! header. Copy this file into your program.
module railtab_contact
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_int, c_null_char, c_ptr, c_size_t
  implicit none
  public

  integer(c_int), parameter :: railtab_ok = 0, railtab_searched = 1, railtab_invalid_input = -1, &
    railtab_out_of_memory = -2, railtab_internal_error = -3
  integer(c_int), parameter :: railtab_left = 0, railtab_right = 1
  integer(c_int), parameter :: railtab_creep_table = 0, railtab_creep_polach = 1, railtab_creep_fastsim = 2, &
    railtab_creep_linear = 3
  integer, parameter :: railtab_max_patches = 8

  type, bind(c) :: railtab_contact_parameters
    real(c_double) :: speed, speed_floor, friction, friction_limit, friction_decay, initial_slope, damping, young, &
      poisson, curvature_floor, k_adhesion, k_slip
    integer(c_int) :: creep_law
  end type

  type, bind(c) :: railtab_dimensions
    real(c_double) :: track_gauge, gauge_height, flange_back, nominal_radius, tape_circle_offset, rail_offset
  end type

  type, bind(c) :: railtab_wheelset_motion
    real(c_double) :: displacement(6) = 0, velocity(6) = 0
  end type

  type, bind(c) :: railtab_rail_motion
    real(c_double) :: displacement(3) = 0, velocity(3) = 0, yaw = 0, slope = 0, friction = 1
  end type

  type, bind(c) :: railtab_wheel_force
    real(c_double) :: wheelset(6), rail(3), rail_x
    integer(c_int) :: touches, outside_creep_table
  end type

  type, bind(c) :: railtab_patch
    real(c_double) :: y_rail, z_rail, y_wheel, z_wheel, x, angle, rolling_radius, penetration, curvature_wheel, &
      curvature_rail, normal_force, a, b, pressure
    integer(c_int) :: concave
  end type

  interface
    function railtab_status_text(status) bind(c)
      import :: c_int, c_ptr
      integer(c_int), value :: status
      type(c_ptr) :: railtab_status_text
    end function

    function railtab_contact_default_parameters(parameters) bind(c)
      import :: c_int, railtab_contact_parameters
      type(railtab_contact_parameters), intent(out) :: parameters
      integer(c_int) :: railtab_contact_default_parameters
    end function

    ! Names of files end with c_null_char; creep_table is left out for the one that comes with railtab.
    function railtab_contact_open(geometry_table, creep_table, parameters, contact, message, message_size) bind(c)
      import :: c_char, c_int, c_ptr, c_size_t, railtab_contact_parameters
      character(kind=c_char), intent(in) :: geometry_table(*)
      character(kind=c_char), intent(in), optional :: creep_table(*)
      type(railtab_contact_parameters), intent(in) :: parameters
      type(c_ptr), intent(out) :: contact
      character(kind=c_char), intent(out) :: message(*)
      integer(c_size_t), value :: message_size
      integer(c_int) :: railtab_contact_open
    end function

    subroutine railtab_contact_close(contact) bind(c)
      import :: c_ptr
      type(c_ptr), value :: contact
    end subroutine

    function railtab_contact_set_speed(contact, speed) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: contact
      real(c_double), value :: speed
      integer(c_int) :: railtab_contact_set_speed
    end function

    function railtab_contact_dimensions(contact, dimensions) bind(c)
      import :: c_int, c_ptr, railtab_dimensions
      type(c_ptr), value :: contact
      type(railtab_dimensions), intent(out) :: dimensions
      integer(c_int) :: railtab_contact_dimensions
    end function

    ! A rail that is left out is at rest.
    function railtab_contact_force(contact, side, wheelset, rail, force) bind(c)
      import :: c_int, c_ptr, railtab_rail_motion, railtab_wheel_force, railtab_wheelset_motion
      type(c_ptr), value :: contact
      integer(c_int), value :: side
      type(railtab_wheelset_motion), intent(in) :: wheelset
      type(railtab_rail_motion), intent(in), optional :: rail
      type(railtab_wheel_force), intent(inout) :: force
      integer(c_int) :: railtab_contact_force
    end function

    ! tangent(j, i) is the derivative of force i with respect to displacement j.
    function railtab_contact_force_and_tangent(contact, side, wheelset, rail, velocity_rate, force, tangent) bind(c)
      import :: c_double, c_int, c_ptr, railtab_rail_motion, railtab_wheel_force, railtab_wheelset_motion
      type(c_ptr), value :: contact
      integer(c_int), value :: side
      type(railtab_wheelset_motion), intent(in) :: wheelset
      type(railtab_rail_motion), intent(in), optional :: rail
      real(c_double), value :: velocity_rate
      type(railtab_wheel_force), intent(inout) :: force
      real(c_double), intent(inout) :: tangent(9, 9)
      integer(c_int) :: railtab_contact_force_and_tangent
    end function

    function railtab_contact_patches(contact, side, wheelset, rail, patches, count) bind(c)
      import :: c_int, c_ptr, railtab_max_patches, railtab_patch, railtab_rail_motion, railtab_wheelset_motion
      type(c_ptr), value :: contact
      integer(c_int), value :: side
      type(railtab_wheelset_motion), intent(in) :: wheelset
      type(railtab_rail_motion), intent(in), optional :: rail
      type(railtab_patch), intent(inout) :: patches(railtab_max_patches)
      integer(c_int), intent(inout) :: count
      integer(c_int) :: railtab_contact_patches
    end function

    function railtab_contact_height(contact, side, y, roll, yaw, load, z) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: contact
      integer(c_int), value :: side
      real(c_double), value :: y, roll, yaw, load
      real(c_double), intent(inout) :: z
      integer(c_int) :: railtab_contact_height
    end function
  end interface

contains

  ! The characters of a C string before its final null.
  function railtab_text(characters) result(text)
    character(kind=c_char), intent(in) :: characters(:)
    character(:), allocatable :: text
    integer :: i
    text = ''
    do i = 1, size(characters)
      if (characters(i) == c_null_char) exit
      text = text // characters(i)
    end do
  end function
end module
