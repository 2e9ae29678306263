// version.h — the version of Glisson: the one place where it is written; CMake and results read it from here.
#pragma once

#define GLISSON_VERSION_MAJOR 0
#define GLISSON_VERSION_MINOR 1
#define GLISSON_VERSION_PATCH 0
#define GLISSON_VERSION "0.1.0"
