//! Heights and water at the lattice points of a level.
