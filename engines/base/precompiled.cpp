/// The headers that all rooms share, so that CMake compiles them once.
