#include "examples/predator_prey/common/program.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace predator_prey {
namespace {

template <class Number>
void AddNumber(CLI::App& app, const char* name, Number& value, const char* help, Accept accept) {
  CLI::Option* option = app.add_option(name, value, help)->capture_default_str();
  if (accept == Accept::kNotNegative) option->check(CLI::NonNegativeNumber);
  if (accept == Accept::kPositive) option->check(CLI::PositiveNumber);
}

}  // namespace

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : app_(std::make_unique<CLI::App>(description, name)) {}

CommandLine::~CommandLine() = default;

void CommandLine::Add(const char* name, double& value, const char* help, Accept accept) {
  AddNumber(*app_, name, value, help, accept);
}

void CommandLine::Add(const char* name, std::uint64_t& value, const char* help, Accept accept) {
  AddNumber(*app_, name, value, help, accept);
}

void CommandLine::Add(const char* name, std::uint32_t& value, const char* help, Accept accept) {
  AddNumber(*app_, name, value, help, accept);
}

void CommandLine::AddBetween(const char* name, double& value, const char* help, double least,
                             double most) {
  app_->add_option(name, value, help)->capture_default_str()->check(CLI::Range(least, most));
}

void CommandLine::AddText(const char* name, std::string& value, const char* help,
                          const std::function<std::string(const std::string&)>& what_is_wrong) {
  app_->add_option(name, value, help)->capture_default_str()->check(what_is_wrong, "");
}

void CommandLine::AddUnlessTold(const char* name, std::uint32_t& value, const char* help, int least,
                                int most) {
  app_->add_option(name, value, help)->check(CLI::Range(least, most));
}

void CommandLine::AddPort(const char* name, std::uint16_t& value, const char* help) {
  app_->add_option(name, value, help)->required()->check(CLI::Range(1, 65535));
}

int CommandLine::Run(int argc, char** argv, const std::function<void()>& body) {
  try {
    app_->parse(argc, argv);
    body();
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error);  // --help
    std::fprintf(stderr, "%s: %s\n", app_->get_name().c_str(), error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app_->get_name().c_str(), error.what());
    return 1;
  }
}

}  // namespace predator_prey
