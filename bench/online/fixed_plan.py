"""A plan made before the run, with its time-varying LQR, in the place of a controller that plans again."""

import numpy as np

import prowl

STEP, STEPS = 0.005, 20  # of an answer [s]


class FixedPlan:
    """For prowl.run_online(planner=...): a stride of a trot in place, planned once and repeated."""

    def __init__(
        self, robot: prowl.Robot, robot_file: str, first_lift: float, stride: float, duty_factor: float
    ) -> None:
        self.plan = prowl.solve(
            {
                "name": "trot in place",
                "robot": robot_file,
                "surface": [{"name": "floor", "friction": 0.6}],
                "gait": {
                    "kind": "trot",
                    "periodic": True,
                    "strides": 2,
                    "stride_s": stride,
                    "stride_length_m": 0.0,
                    "duty_factor": duty_factor,
                },
            }
        )
        if not self.plan.good:
            raise RuntimeError(f"the fixed plan failed: {self.plan.status}")
        self.tracker, self.stride, self.first_lift = self.plan.tracker, stride, first_lift
        times = np.arange(self.tracker.start, self.tracker.end, 1e-3)
        stands = [len(self.tracker.contacts(t)) for t in times]
        self.lift = times[next(k for k in range(1, len(times)) if stands[k] < stands[k - 1])]
        standing = prowl.Controller(robot, "stand")
        q, v = standing.standing, np.zeros(robot.nv)
        tau = standing.torque(0.0, q, v)
        self.standing = (q, v, tau, -self.tracker.gains(0.5 * self.lift))  # until the first lift-off

    def __call__(self, request: prowl.MotionRequest) -> prowl.MotionSteps:
        t = request.start + STEP * np.arange(STEPS + 1)
        nodes = [self._node(time) for time in t]
        q, v, tau, gains = (np.array(part) for part in zip(*nodes))
        return prowl.MotionSteps(t, q, v, tau[:-1], gains[:-1])

    def _node(self, t: float) -> tuple[np.ndarray, ...]:
        if t < self.first_lift:
            return self.standing
        time = self.lift + (t - self.first_lift) % self.stride
        return (*self.tracker.reference(time), self.tracker.feedforward(time), -self.tracker.gains(time))
