// The exceptions that cross library boundaries. Programs catch splice::Error, print what() as one line on stderr and
// exit 2 for a UsageError, 1 for anything else. Anything that is not a splice::Error is a defect of the program.
#pragma once

#include <stdexcept>
#include <string>

namespace splice {

class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The command line asks for something that does not exist or contradicts itself.
class UsageError : public Error {
  public:
    using Error::Error;
};

/// A file cannot be used: what() is "FILE:WHERE: what was found, what was expected", WHERE a line ("line 12"), a byte
/// offset ("byte 84") or a JSON path, or left out when the file as a whole is at fault.
class InputError : public Error {
  public:
    InputError(const std::string& file, const std::string& where, const std::string& problem)
        : Error(where.empty() ? file + ": " + problem : file + ": " + where + ": " + problem) {}
};

/// The operating system or the disk refused: what() names the file and the reason.
class SystemError : public Error {
  public:
    using Error::Error;
};

/// No usable Vulkan device, or the device failed.
class DeviceError : public Error {
  public:
    using Error::Error;
};

}  // namespace splice
