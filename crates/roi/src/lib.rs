//! A selected region of a bone surface as its own mesh.
