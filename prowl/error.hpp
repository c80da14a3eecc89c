#pragma once

#include <stdexcept>
#include <string>

namespace prowl {

/// Base of every exception that Prowl throws on purpose. The message is one sentence for the user: what is wrong,
/// where, and what would be right.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller or a file asks for something that cannot be: unknown name, wrong type, value out of range.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A file or a folder cannot be read or written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// A model evaluation gave NaN or infinity, or a matrix that must be regular is not.
class NumericalError : public Error {
 public:
  using Error::Error;
};

}  // namespace prowl
