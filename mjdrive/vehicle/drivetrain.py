"""From the acceleration that a driver wants to the pedals of the car, and back."""

import math
from typing import NamedTuple

from mjdrive.vehicle.parameters import AIR_DENSITY, VehicleParameters

NUM_WHEELS = 4


class Drivetrain(NamedTuple):
    """Forces along the road as accelerations of the car, at rest and per speed.

    Attributes:
        traction: Acceleration at full throttle from rest [m/s2].
        traction_slope: What it loses per speed [1/s].
        dead_band: Throttle up to which there is no traction; from there it grows in proportion [-].
        braking: Deceleration at full brake [m/s2].
        rolling: Deceleration by rolling resistance [m/s2].
        drag: Deceleration by air per square of the speed [1/m].
        throttle_lag: Time constant of the throttle [s].
        brake_lag: Time constant of the brake [s].
    """

    traction: float
    traction_slope: float
    dead_band: float
    braking: float
    rolling: float
    drag: float
    throttle_lag: float
    brake_lag: float

    @staticmethod
    def of(car: VehicleParameters) -> "Drivetrain":
        """Divide the torques of a car by its wheel radius and by its mass, with that of its turning wheels."""
        mass = car.mass + NUM_WHEELS * car.wheel_inertia / car.wheel_radius**2
        per_torque = 1.0 / (car.wheel_radius * mass)
        return Drivetrain(
            traction=car.drive_torque * per_torque,
            traction_slope=car.drive_torque_slope * per_torque / car.wheel_radius,
            dead_band=car.throttle_dead_band,
            braking=car.brake_torque * per_torque,
            rolling=NUM_WHEELS * car.rolling_torque * per_torque,
            drag=0.5 * AIR_DENSITY * car.drag_area / mass,
            throttle_lag=car.throttle_lag,
            brake_lag=car.brake_lag,
        )

    def full_throttle(self, speed: float) -> float:
        """Acceleration that the engine gives at a speed [m/s] before resistance [m/s2]."""
        return max(self.traction - self.traction_slope * speed, 0.0)

    def resistance(self, speed: float) -> float:
        """Deceleration of a car that rolls freely at a speed [m/s] [m/s2]."""
        return self.rolling + self.drag * speed * speed

    def acceleration(self, pedal: float, speed: float) -> float:
        """Acceleration in the end, if a pedal is held at a speed.

        Args:
            pedal: Throttle if positive, brake if negative, in [-1, 1] [-].
            speed: Forward speed, more than 0 [m/s].

        Returns:
            Acceleration of the car once its actuators have settled [m/s2].
        """
        if pedal <= 0:
            return pedal * self.braking - self.resistance(speed)
        share = max(pedal - self.dead_band, 0.0) / (1.0 - self.dead_band)
        return share * self.full_throttle(speed) - self.resistance(speed)

    def pedal(self, acceleration: float, speed: float) -> float:
        """Pedal that gives an acceleration; undoes `acceleration` within the limits of the car.

        Args:
            acceleration: What is wanted [m/s2].
            speed: Forward speed [m/s].

        Returns:
            Throttle if positive, brake if negative, in [-1, 1] [-].
        """
        wanted = acceleration + self.resistance(speed)
        if wanted <= 0:
            return float(max(wanted / self.braking, -1.0))
        full = self.full_throttle(speed)
        share = min(wanted / full, 1.0) if full > 0 else 1.0
        return float(self.throttle(share))

    def throttle(self, share: float) -> float:
        """Throttle that gives a share of what the engine can: over the dead band, but for a share of 0 [-]."""
        return self.dead_band + (1.0 - self.dead_band) * share if share > 0 else 0.0

    def lag(self, acceleration: float, speed: float) -> float:
        """Time constant of the pedal that an acceleration [m/s2] at a speed [m/s] asks for [s]."""
        return self.throttle_lag if acceleration + self.resistance(speed) > 0 else self.brake_lag

    def pedal_towards(
        self, wanted: float, *, before: float, speed: float, interval: float
    ) -> float:
        """Pedal that brings the car from one acceleration to another within an interval, against the lag of the pedal.

        Args:
            wanted: Acceleration at the end of the interval [m/s2].
            before: Acceleration at its beginning [m/s2].
            speed: Forward speed [m/s].
            interval: Time for which the pedal is held [s].

        Returns:
            Throttle if positive, brake if negative, in [-1, 1] [-].
        """
        lag = self.lag(wanted, speed)
        reached = 1.0 - math.exp(-interval / lag) if lag > 0 else 1.0
        return self.pedal(before + (wanted - before) / reached, speed)
