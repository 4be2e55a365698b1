/// Nothing but the headers that the rooms share, for CMake to compile them once.
