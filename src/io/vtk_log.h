// vtk_log.h — VTK's messages, caught before they reach the terminal.
#pragma once

#include <string>

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>

namespace glisson::detail {

/// Keeps the first error or warning of the algorithms that it observes.
class VtkErrorLog : public vtkCommand {
 public:
  static VtkErrorLog* New() { return new VtkErrorLog; }

  /// Takes the messages of an object.
  void observe(vtkObject& object) {
    object.AddObserver(vtkCommand::ErrorEvent, this);
    object.AddObserver(vtkCommand::WarningEvent, this);
  }

  /// Takes the messages of an algorithm and of the pipeline around it.
  void observe_pipeline(vtkAlgorithm& algorithm) {
    observe(algorithm);
    observe(*algorithm.GetExecutive());
  }

  void Execute(vtkObject*, unsigned long event, void* data) override {
    if (event != vtkCommand::ErrorEvent && event != vtkCommand::WarningEvent) return;
    if (first_.empty() && data != nullptr) first_ = plain(static_cast<const char*>(data));
  }

  /// @return the text of the first message; empty if there was none
  const std::string& first() const { return first_; }

 private:
  /// "ERROR: In FILE, line N\nCLASS (ADDRESS): TEXT\n\n" → "TEXT"
  static std::string plain(std::string text) {
    if (const auto head = text.find("): "); head != std::string::npos) text.erase(0, head + 3);
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    for (char& c : text) c = c == '\n' ? ' ' : c;
    return text;
  }

  std::string first_;
};

}  // namespace glisson::detail
