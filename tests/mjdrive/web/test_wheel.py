"""One holder at a time, and nothing stays pressed when the page falls silent."""

from itertools import pairwise

from mjdrive.web.wheel import LETS_GO_AFTER, Wheel

INTERVAL = 0.1


class Clock:
    """A clock that stands still until it is moved."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


def held(*keys: str) -> tuple[Wheel, Clock]:
    clock = Clock()
    wheel = Wheel(clock)
    assert wheel.take("me")
    wheel.say("me", keys=frozenset(keys), seq=1)
    return wheel, clock


def test_nobody_takes_a_wheel_that_is_held() -> None:
    wheel, _ = held()
    assert not wheel.take("you")
    assert not wheel.give_back("you")
    assert wheel.give_back("me")
    assert wheel.take("you")


def test_keys_of_those_who_do_not_hold_it_do_nothing() -> None:
    wheel, _ = held()
    wheel.say("you", keys=frozenset({"up"}), seq=9)
    assert wheel.seq == 1
    assert wheel.action(INTERVAL).acceleration == 0.0


def test_two_keys_are_held_at_once_and_reach_the_limits() -> None:
    wheel, _ = held("up", "left")
    actions = [wheel.action(INTERVAL) for _ in range(20)]
    assert actions[0].steering > 0 < actions[0].acceleration
    assert (actions[-1].acceleration, actions[-1].steering) == (1.0, 1.0)
    assert all(a.steering <= b.steering for a, b in pairwise(actions))


def test_released_keys_centre_the_wheel() -> None:
    wheel, _ = held("up", "right")
    wheel.action(INTERVAL)
    wheel.say("me", seq=2)
    last = [wheel.action(INTERVAL) for _ in range(20)][-1]
    assert (last.acceleration, last.steering) == (0.0, 0.0)


def test_silence_lets_go() -> None:
    wheel, clock = held("up")
    before = wheel.action(INTERVAL)
    clock.now += LETS_GO_AFTER + 0.01
    assert wheel.action(INTERVAL).acceleration < before.acceleration


def test_braking_does_not_wait_for_the_throttle_to_be_released() -> None:
    wheel, _ = held("up")
    for _ in range(10):
        wheel.action(INTERVAL)
    wheel.say("me", keys=frozenset({"down"}), seq=2)
    assert wheel.action(INTERVAL).acceleration < 0.0


def test_a_gamepad_is_followed_as_it_is() -> None:
    wheel, _ = held()
    wheel.say("me", analog=(0.3, -0.4), seq=2)
    action = wheel.action(INTERVAL)
    assert (action.acceleration, action.steering) == (0.3, -0.4)
