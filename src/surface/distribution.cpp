#include <umov/surface/distribution.h>

#include "surface/distribution_models.h"

#include <cmath>
#include <fmt/format.h>
#include <umov/core/locks.h>
#include <umov/core/text.h>

namespace umov {
namespace {

const DistributionModel *find_model(const std::string &name) {
  for (const DistributionModel *model : distribution_models())
    if (name == model->name)
      return model;
  return nullptr;
}

tl::unexpected<Error> unknown_model(const std::string &name) {
  std::vector<std::string> known;
  for (const DistributionModel *model : distribution_models())
    known.emplace_back(model->name);
  const auto near = nearest_name(name, known);
  return fail(ErrorCode::BadInput,
              fmt::format("distribution model \"{}\" is unknown; one of {} was expected.{}", name,
                          fmt::join(known, ", "),
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

Result<void> check_table(const DistributionChoice &choice) {
  const auto &angle = choice.angle_deg;
  if (angle.size() < 3 || angle.size() != choice.density.size())
    return fail(ErrorCode::BadInput,
                fmt::format("the table of normals has {} angles and {} densities; as many of both, "
                            "at least 3, were expected",
                            angle.size(), choice.density.size()));
  double sum = 0;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    if (!(angle[i] >= 0 && angle[i] <= 90) || (i > 0 && !(angle[i] > angle[i - 1])))
      return fail(ErrorCode::BadInput,
                  fmt::format("angle {} of the table of normals; increasing ones from 0 to 90 deg "
                              "were expected",
                              angle[i]));
    if (!(choice.density[i] >= 0) || !std::isfinite(choice.density[i]))
      return fail(ErrorCode::BadInput,
                  fmt::format("density {} in the table of normals; 0 or more was expected",
                              choice.density[i]));
    sum += choice.density[i];
  }
  if (angle.front() != 0 || !(sum > 0))
    return fail(ErrorCode::BadInput,
                "the table of normals must begin at 0 deg and hold a density above 0");
  return {};
}

/// The last that were made, which never change: a material is checked when it is read and again
/// when it is compiled, objects share theirs, and to integrate a masking takes milliseconds.
class LastMade {
public:
  std::shared_ptr<const Distribution> of(const DistributionModel &model,
                                         const DistributionChoice &choice) {
    {
      const ReadLock lock(mutex_);
      for (const auto &[known, made] : last_)
        if (known == choice)
          return made;
    }
    auto made = model.make(choice);
    const WriteLock lock(mutex_);
    if (last_.size() < room)
      last_.emplace_back(choice, made);
    else
      last_[oldest_++ % room] = {choice, made};
    return made;
  }

private:
  static constexpr std::size_t room = 32;
  Mutex mutex_;
  std::size_t oldest_ = 0;
  std::vector<std::pair<DistributionChoice, std::shared_ptr<const Distribution>>> last_;
};

} // namespace

DistributionChoice blinn_phong(double m) { return {"blinn_phong", {{"m", m}}, {}, {}, {}}; }

const std::vector<const DistributionModel *> &distribution_models() {
  static const std::vector<const DistributionModel *> all = list_distribution_models();
  return all;
}

Result<std::shared_ptr<const Distribution>> make_distribution(const DistributionChoice &choice) {
  const DistributionModel *model = find_model(choice.model);
  if (model == nullptr)
    return unknown_model(choice.model);
  for (const DistributionParameter &one : model->parameters) {
    const auto given = choice.parameters.find(one.name);
    if (given == choice.parameters.end())
      return fail(ErrorCode::BadInput,
                  fmt::format("distribution {} needs {} ({})", model->name, one.name, one.text));
    if (!(given->second >= one.low && given->second <= one.high))
      return fail(ErrorCode::BadInput, fmt::format("{} = {:g}; {:g} to {:g} was expected", one.name,
                                                   given->second, one.low, one.high));
  }
  if (choice.parameters.size() > model->parameters.size())
    for (const auto &[name, value] : choice.parameters) {
      bool is_known = false;
      for (const DistributionParameter &one : model->parameters)
        is_known = is_known || name == one.name;
      if (!is_known)
        return fail(
            ErrorCode::BadInput,
            fmt::format("{} has no meaning with model = \"{}\"; leave it out", name, model->name));
    }
  if (model->takes_table)
    UMOV_TRY(check_table(choice));
  static auto *const last_made = new LastMade; // as long as any thread runs
  return last_made->of(*model, choice);
}

} // namespace umov
