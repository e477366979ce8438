#pragma once
#include <string>

namespace spindrift {

// How fast the shipped scenes run, as simulated seconds per second of wall time: each as it is and,
// where it may be, incompressible; alone and with 30 pictures a second (1280 x 800, off screen). A
// table on standard output, of scenes whose name contains `only`. Returns Exit::Ok. Throws Error.
int benchRealTime(const std::string& only);

}  // namespace spindrift
