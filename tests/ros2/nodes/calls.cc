// Services, actions and parameters of rclcpp, between two processes.
//   calls server    adds numbers, counts (an action of a tenth of a second each), and has a
//   parameter `limit` calls client    asks for all of it, says what it got, and ends
#include <chrono>
#include <cstdio>
#include <example_interfaces/action/fibonacci.hpp>
#include <example_interfaces/srv/add_two_ints.hpp>
#include <future>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>
#include <string>
#include <vector>

namespace {

using namespace std::chrono_literals;
using Add = example_interfaces::srv::AddTwoInts;
using Count = example_interfaces::action::Fibonacci;
using GoalHandle = rclcpp_action::ServerGoalHandle<Count>;

class Server : public rclcpp::Node {
 public:
  Server() : Node("server") {
    declare_parameter("limit", 5);
    service_ = create_service<Add>("add", [](const Add::Request::SharedPtr& request,
                                             const Add::Response::SharedPtr& response) {
      response->sum = request->a + request->b;
    });
    action_ = rclcpp_action::create_server<Count>(
        this, "count",
        [this](const rclcpp_action::GoalUUID&, const std::shared_ptr<const Count::Goal>& goal) {
          return goal->order > get_parameter("limit").as_int()
                     ? rclcpp_action::GoalResponse::REJECT
                     : rclcpp_action::GoalResponse::ACCEPT_AND_EXECUTE;
        },
        [](const std::shared_ptr<GoalHandle>&) { return rclcpp_action::CancelResponse::ACCEPT; },
        [this](const std::shared_ptr<GoalHandle>& goal) { Begin(goal); });
  }

 private:
  void Begin(const std::shared_ptr<GoalHandle>& goal) {
    goal_ = goal;
    numbers_ = {};
    timer_ = create_wall_timer(100ms, [this] { Go(); });
  }
  void Go() {
    auto result = std::make_shared<Count::Result>();
    result->sequence = numbers_;
    if (goal_->is_canceling()) {
      timer_->cancel();
      goal_->canceled(result);
    } else if (static_cast<int>(numbers_.size()) == goal_->get_goal()->order) {
      timer_->cancel();
      goal_->succeed(result);
    } else {
      numbers_.push_back(static_cast<int>(numbers_.size()));
      auto feedback = std::make_shared<Count::Feedback>();
      feedback->sequence = numbers_;
      goal_->publish_feedback(feedback);
    }
  }

  rclcpp::Service<Add>::SharedPtr service_;
  rclcpp_action::Server<Count>::SharedPtr action_;
  std::shared_ptr<GoalHandle> goal_;
  std::vector<int> numbers_;
  rclcpp::TimerBase::SharedPtr timer_;
};

double Now() {
  return static_cast<double>(std::chrono::steady_clock::now().time_since_epoch() / 1ns) * 1e-9;
}

int Fails(const char* what) {
  std::printf("%s\n", what);
  rclcpp::shutdown();
  return 1;
}

int Ask() {
  const auto node = std::make_shared<rclcpp::Node>("client");
  const auto add = node->create_client<Add>("add");
  if (!add->wait_for_service(10s)) return Fails("there is no service");
  for (int i = 0; i < 100; ++i) {
    auto request = std::make_shared<Add::Request>();
    request->a = i, request->b = 2 * i;
    auto answer = add->async_send_request(request);
    if (rclcpp::spin_until_future_complete(node, answer, 5s) != rclcpp::FutureReturnCode::SUCCESS)
      return Fails("no answer");
    if (answer.get()->sum != 3 * i) return Fails("a wrong sum");
  }
  std::printf("100 sums\n");

  const auto count = rclcpp_action::create_client<Count>(node, "count");
  if (!count->wait_for_action_server(10s)) return Fails("there is no action");
  int told = 0;
  rclcpp_action::Client<Count>::SendGoalOptions options;
  options.feedback_callback = [&told](const auto&, const auto&) { ++told; };
  const auto send = [&](int order) {
    Count::Goal goal;
    goal.order = order;
    auto handle = count->async_send_goal(goal, options);
    rclcpp::spin_until_future_complete(node, handle, 5s);
    return handle.get();
  };
  if (send(6) != nullptr) return Fails("a goal beyond the limit was accepted");
  rclcpp::AsyncParametersClient parameters(node, "server");
  if (!parameters.wait_for_service(10s)) return Fails("there are no parameters");
  auto set = parameters.set_parameters({rclcpp::Parameter("limit", 10)});
  rclcpp::spin_until_future_complete(node, set, 5s);
  if (!set.get()[0].successful) return Fails("the parameter was not set");

  const double begun = Now();
  auto result = count->async_get_result(send(6));
  rclcpp::spin_until_future_complete(node, result, 20s);
  std::printf("a goal: %zu numbers, %d times told, %.1f s\n", result.get().result->sequence.size(),
              told, Now() - begun);

  const auto other = send(10);
  std::promise<void> never;
  rclcpp::spin_until_future_complete(node, never.get_future().share(), 350ms);
  auto cancelled = count->async_cancel_goal(other);
  rclcpp::spin_until_future_complete(node, cancelled, 5s);
  auto left = count->async_get_result(other);
  rclcpp::spin_until_future_complete(node, left, 5s);
  std::printf("a cancelled one: %s, %zu numbers\n",
              left.get().code == rclcpp_action::ResultCode::CANCELED ? "cancelled" : "not",
              left.get().result->sequence.size());
  rclcpp::shutdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  if (argc > 1 && std::string(argv[1]) == "client") return Ask();
  rclcpp::spin(std::make_shared<Server>());
  rclcpp::shutdown();
}
