import pickle

import pytest

from mjdrive import errors
from mjdrive.errors import MjdriveError


def kinds(kind: type[MjdriveError] = MjdriveError) -> list[type[MjdriveError]]:
    return [kind, *(each for child in kind.__subclasses__() for each in kinds(child))]


@pytest.mark.parametrize("kind", kinds(), ids=lambda kind: kind.__name__)
def test_errors_come_over_from_another_process_as_they_are(kind: type[MjdriveError]) -> None:
    error = kind.__new__(kind, "what was given")
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again)) == (kind, "what was given")


def test_error_that_makes_its_own_message_keeps_it() -> None:
    error = errors.UnknownNameError("town", "town2", ["town01", "town02"], hint="Look again.")
    again = pickle.loads(pickle.dumps(error))
    assert isinstance(again, errors.UnknownNameError)
    assert str(again) == str(error)
    assert "Did you mean 'town02'?" in str(again)
