//! From a CT folder to a bone mesh and a selected region: settings, steps, command line.
