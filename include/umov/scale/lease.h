#pragma once
// Who is at work in a folder, so that no work is done twice. Correctness never rests on it.

#include <filesystem>
#include <memory>
#include <string>
#include <umov/core/result.h>

namespace umov::scale {

/// A file that is renewed while its owner lives.
class Lease {
public:
  /// `part`: "" for the whole job, else "K-of-N": whoever has the whole and whoever has the same
  /// part are in the way. Device naming them.
  static Result<Lease> take(const std::filesystem::path &folder, const std::string &part);
  /// Of one who works beside others, whoever they are. Device where it cannot be written.
  static Result<Lease> join(const std::filesystem::path &folder);
  Lease(Lease &&) noexcept;
  Lease &operator=(Lease &&) noexcept;
  ~Lease(); ///< gives it back
  /// Nobody else holds any lease of the folder.
  [[nodiscard]] bool is_alone() const;

private:
  struct State;
  explicit Lease(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Who holds leases of a folder, in words; "" for nobody.
std::string lease_holders(const std::filesystem::path &folder);

} // namespace umov::scale
