// A talker and a listener of rclcpp.
//   talk talker COUNT PERIOD_US    writes so many numbers, one each period, once somebody listens,
//   and ends when the listener has talk listener COUNT            takes them, and says how many
//   came, in order, how late they were, and at which rate
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int64_multi_array.hpp>
#include <string>
#include <vector>

namespace {

using Numbers = std_msgs::msg::Int64MultiArray;

std::int64_t Now() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

class Talker : public rclcpp::Node {
 public:
  Talker(std::int64_t count, std::chrono::microseconds period) : Node("talker"), count_(count) {
    publisher_ = create_publisher<Numbers>("numbers", rclcpp::QoS(rclcpp::KeepAll()).reliable());
    timer_ = create_wall_timer(period, [this] { Tick(); });
  }

 private:
  void Tick() {
    if (next_ == count_) {
      if (publisher_->get_subscription_count() == 0) rclcpp::shutdown();
      return;
    }
    if (publisher_->get_subscription_count() == 0) return;
    Numbers numbers;
    numbers.data = {next_++, Now()};
    publisher_->publish(numbers);
  }

  std::int64_t count_, next_ = 0;
  rclcpp::Publisher<Numbers>::SharedPtr publisher_;
  rclcpp::TimerBase::SharedPtr timer_;
};

class Listener : public rclcpp::Node {
 public:
  explicit Listener(std::int64_t count) : Node("listener"), count_(count) {
    subscription_ =
        create_subscription<Numbers>("numbers", rclcpp::QoS(rclcpp::KeepAll()).reliable(),
                                     [this](const Numbers& numbers) { Take(numbers); });
  }

 private:
  void Take(const Numbers& numbers) {
    const std::int64_t now = Now();
    if (numbers.data[0] != static_cast<std::int64_t>(late_.size())) in_order_ = false;
    late_.push_back(now - numbers.data[1]);
    sent_.push_back(numbers.data[1]);
    if (static_cast<std::int64_t>(late_.size()) == count_) Say();
  }

  void Say() {
    std::vector<std::int64_t> sorted = late_;
    std::sort(sorted.begin(), sorted.end());
    const double seconds = static_cast<double>(sent_.back() - sent_.front()) * 1e-9;
    std::printf("%zu %s, late by %.1f to %.1f us, half by %.1f, at %.1f Hz\n", late_.size(),
                in_order_ ? "in order" : "out of order", static_cast<double>(sorted.front()) * 1e-3,
                static_cast<double>(sorted.back()) * 1e-3,
                static_cast<double>(sorted[sorted.size() / 2]) * 1e-3,
                static_cast<double>(late_.size() - 1) / seconds);
    rclcpp::shutdown();
  }

  std::int64_t count_;
  bool in_order_ = true;
  std::vector<std::int64_t> late_, sent_;
  rclcpp::Subscription<Numbers>::SharedPtr subscription_;
};

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  const std::string role = argc > 2 ? argv[1] : "";
  const long count = argc > 2 ? std::atol(argv[2]) : 0;
  if (role == "talker" && argc > 3) {
    rclcpp::spin(std::make_shared<Talker>(count, std::chrono::microseconds(std::atol(argv[3]))));
  } else if (role == "listener") {
    rclcpp::spin(std::make_shared<Listener>(count));
  } else {
    std::fprintf(stderr, "usage: talk talker COUNT PERIOD_US | talk listener COUNT\n");
    return 2;
  }
  rclcpp::shutdown();
}
