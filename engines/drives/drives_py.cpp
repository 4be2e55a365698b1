/// Python bindings of the drives.
#include "engines/drives/DrumDrive.hpp"
#include "engines/drives/OscillationDrive.hpp"
#include "engines/drives/ShearDrive.hpp"
#include "engines/drives/SpinTranslateDrive.hpp"
#include "engines/seam/bind.hpp"

namespace graindrive {

void bind_drives()
{
	seam::bind<OscillationDrive>(OscillationDrive::documentation);
	seam::bind<SpinTranslateDrive>(SpinTranslateDrive::documentation);
	seam::bind<DrumDrive>(DrumDrive::documentation);
	seam::bind<ShearDrive>(ShearDrive::documentation).def("clear", &ShearDrive::clear, "Reset the sums to zero.");
}

}  // namespace graindrive
