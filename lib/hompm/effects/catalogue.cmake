# The effects a scene may call for, in the order of --list: NAME.cpp defines `EffectType NAME()`.
set(effects
  gravity
  traction
  mass_damping
  local_damping
  viscosity
  bulk_viscosity
  manufactured
  piston
  wall
  absorbing
  contact
  interface
)
