#include "coordinator/fit/fit_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "coordinator/report/statistics.h"
#include "coordinator/report/text.h"
#include "coordinator/text/text_table.h"

namespace tcs::fit {

namespace {

// With this share of the charge in other activations than it was measured in, hardly more than the
// sums agree.
constexpr double kLargeMisfit = 0.8;
// The time from one call or allocation to the next, on average. A robot's programs are woken every
// 1 to 20 ms, and notice such steps.
constexpr double kLongStepNs = 1e6;

// "1.86 us"; for a terminal, so without spaces that do not break.
std::string Ns(double ns) {
  std::string text = report::Seconds(ns * 1e-9);
  for (std::size_t at; (at = text.find("\u00a0")) != std::string::npos;) text.replace(at, 2, " ");
  for (std::size_t at; (at = text.find("\u202f")) != std::string::npos;) text.replace(at, 3, " ");
  for (std::size_t at; (at = text.find("\u00b5")) != std::string::npos;) text.replace(at, 2, "u");
  return text;
}

std::string Cost(const std::optional<std::int64_t>& ns) {
  return ns.has_value() ? Ns(static_cast<double>(*ns)) : "-";
}

std::string Both(double measured_ns, double fitted_ns) {
  return Ns(measured_ns) + " | " + Ns(fitted_ns);
}

// The measured charges and those of the costs, each in their order.
struct Charges {
  std::vector<double> measured, fitted;
};

Charges ChargesOf(const Costs& costs, const std::vector<Work>& activations) {
  Charges charges;
  for (const Work& w : activations) {
    charges.measured.push_back(w.charged_ns);
    charges.fitted.push_back(costs.ChargeOf(w));
  }
  std::sort(charges.measured.begin(), charges.measured.end());
  std::sort(charges.fitted.begin(), charges.fitted.end());
  return charges;
}

std::vector<std::string> RowOf(const ClientFit& fit, const MeasuredClient& client) {
  const Charges charges = ChargesOf(fit.costs, client.activations);
  const auto at = [&charges](double share) {
    if (charges.measured.empty()) return std::string("-");
    return Both(report::Quantile(charges.measured, share), report::Quantile(charges.fitted, share));
  };
  return {fit.client,
          Cost(fit.costs.call_ns),
          Cost(fit.costs.allocation_ns),
          Both(client.whole.charged_ns, fit.costs.ChargeOf(client.whole)),
          at(0.5),
          at(0.95),
          at(1),
          client.activations.empty()
              ? "-"
              : fmt::format("{:.0f} %", 100 * MisfitOf(fit.costs, client.activations))};
}

std::string WarningOf(const std::string& name, const MeasuredClient& client, const Costs& costs) {
  const Work& whole = client.whole;
  if (whole.charged_ns <= 0) return {};
  const double steps = whole.calls + whole.allocations;
  if (steps == 0) {
    return fmt::format(
        "{} has computed {} without a call or an allocation, which fixed accounting cannot charge: "
        "run it with --accounting measured",
        name, Ns(whole.charged_ns));
  }
  if (const double step_ns = whole.charged_ns / steps; step_ns > kLongStepNs) {
    return fmt::format(
        "{} computes {} from one call or allocation to the next, which fixed accounting charges "
        "all at once: what it does between comes too late or too early by that",
        name, Ns(step_ns));
  }
  if (const double misfit = MisfitOf(costs, client.activations); misfit > kLargeMisfit) {
    return fmt::format(
        "calls and allocations do not tell how long {} computes: with these costs all its "
        "activations together are charged what was measured, but a single one {:.0f} % more or "
        "less on average",
        name, 100 * misfit);
  }
  return {};
}

}  // namespace

std::vector<ClientFit> FitAll(const MeasuredRun& run) {
  std::vector<ClientFit> fits;
  for (const auto& [name, client] : run.clients) {
    fits.push_back({name, FitCosts(client.whole, client.activations)});
  }
  return fits;
}

std::string FitTable(const MeasuredRun& run, const std::vector<ClientFit>& fits) {
  TextTable table({{"measured | with these costs", false},
                   {"a call"},
                   {"an allocation"},
                   {"charged in all"},
                   {"activations' median"},
                   {"95 % below"},
                   {"longest"},
                   {"misfit"}});
  for (const ClientFit& fit : fits) table.Row(RowOf(fit, run.clients.at(fit.client)));
  return table.Text();
}

std::vector<std::string> FitWarnings(const MeasuredRun& run, const std::vector<ClientFit>& fits) {
  std::vector<std::string> warnings;
  for (const ClientFit& fit : fits) {
    std::string warning = WarningOf(fit.client, run.clients.at(fit.client), fit.costs);
    if (!warning.empty()) warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace tcs::fit
