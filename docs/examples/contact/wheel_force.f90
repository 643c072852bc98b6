! Forces, derivatives and contact patches of the wheels of a wheelset that has moved aside: wheel_force.c in Fortran.
!
!   wheel_force TABLE.h5
program wheel_force
  use, intrinsic :: iso_c_binding
  use, intrinsic :: iso_fortran_env, only: error_unit
  use railtab_contact
  implicit none

  type(railtab_contact_parameters) :: parameters
  type(c_ptr) :: contact
  character(kind=c_char) :: message(400)
  character(1000) :: file
  integer(c_int) :: status

  call get_command_argument(1, file)
  status = railtab_contact_default_parameters(parameters)
  parameters%speed = 20
  status = railtab_contact_open(trim(file) // c_null_char, parameters=parameters, contact=contact, message=message, &
    message_size=size(message, kind=c_size_t))
  if (status /= railtab_ok) then
    write (error_unit, '(2a)') 'wheel_force: ', railtab_text(message)
    stop 1
  end if

  call print_wheel('left', railtab_left)
  call print_wheel('right', railtab_right)
  call railtab_contact_close(contact)

contains

  subroutine print_numbers(name, number)
    character(*), intent(in) :: name
    real(c_double), intent(in) :: number(:)
    print '(a, *(1x, es24.16e3))', name, number
  end subroutine

  ! Of a wheelset that is 1 mm to the right, turned to the right by 0.5 mrad and moving to the right at 10 mm/s, at the
  ! height at which this wheel carries 60 kN.
  subroutine print_wheel(name, side)
    character(*), intent(in) :: name
    integer(c_int), intent(in) :: side
    real(c_double), parameter :: velocity_rate = 200  ! of a time step of 10 ms by the trapezoidal rule: 2/h [1/s]
    type(railtab_wheelset_motion) :: wheelset
    type(railtab_wheel_force) :: force
    type(railtab_patch) :: patches(railtab_max_patches)
    real(c_double) :: tangent(9, 9)
    integer(c_int) :: count
    integer :: i
    wheelset%displacement = [0d0, 1d-3, 0d0, 0d0, 0d0, 5d-4]
    wheelset%velocity(2) = 1d-2
    status = railtab_contact_height(contact, side, 1d-3, 0d0, 5d-4, 60d3, wheelset%displacement(3))
    if (status < 0) stop 1
    status = railtab_contact_force_and_tangent(contact, side, wheelset, velocity_rate=velocity_rate, force=force, &
      tangent=tangent)
    if (status < 0) stop 1
    print '(2a)', name, ' wheel'
    call print_numbers('on the wheelset', force%wheelset)
    call print_numbers('on the rail', force%rail)
    do i = 1, 9
      call print_numbers('derivatives', tangent(:, i))
    end do
    status = railtab_contact_patches(contact, side, wheelset, patches=patches, count=count)
    if (status < 0) stop 1
    do i = 1, count
      call print_numbers('patch', [patches(i)%y_rail, patches(i)%z_rail, patches(i)%angle, patches(i)%rolling_radius, &
        patches(i)%normal_force, patches(i)%a, patches(i)%b])
    end do
  end subroutine
end program
