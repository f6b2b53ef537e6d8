"""Look development without a window: a live stage, its session, and the thread that refines the image."""

import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from scratchwarp.image.quick import eight_bit
from scratchwarp.plan.resolve import resolve
from scratchwarp.render import Film, Session
from scratchwarp.scene import Control, Scene, Settings
from scratchwarp.stage import LiveStage

from .turning import Move, moved

EMPTY = np.zeros((1, 1, 3), np.uint8)


@dataclass(frozen=True, eq=False)
class Shown:
    """What there is to see.

    Attributes:
        version: higher than that of anything shown before. pixels: uint8 [h, w, 3] sRGB, perhaps of a smaller image.
        picture: version of the pixels; edits: how many changes were made.
        size: of the whole image. samples, spp: a pixel, there and wanted (0 samples: a smaller image).
        redone: what the last change did again. message: what went wrong, "" if nothing.
        controls: everything that can be turned, with values. scene: as it is.
    """

    version: int = 0
    pixels: np.ndarray = field(default_factory=lambda: EMPTY)
    picture: int = 0
    edits: int = 0
    size: tuple[int, int] = (1, 1)
    samples: int = 0
    spp: int = 0
    redone: str = ""
    message: str = "reading tables and compiling the kernel"
    controls: tuple[Control, ...] = ()
    scene: Scene | None = None

    @property
    def finished(self) -> bool:
        """Whether the image has all its samples."""
        return 0 < self.spp == self.samples


class Looking:
    """A live stage whose image refines in a thread, and which takes edits from any other.

    Edits that come while a step is traced interrupt it after the tile at hand; those to the same attribute replace each
    other, moves add up. What is at fault is told in ``Shown.message`` and leaves everything as it was.

    Attributes: shown: what there is to see now; stage: the path of the stage.
    """

    def __init__(self, live: LiveStage, settings: Settings | None = None) -> None:
        self._live, self._settings = live, settings or Settings()
        self.stage = live.path
        self._condition = threading.Condition()
        self._values: dict[str, Any] = {}
        self._moves: dict[str, Move] = {}
        self._places: dict[str, np.ndarray] = {}
        self._calls: list[tuple[Future[Any], Callable[[], Any]]] = []
        self._closed = False
        self._failure: BaseException | None = None
        self._session: Session | None = None
        self.shown = Shown(controls=live.controls(), scene=live.scene, size=_size(live.scene, self._settings))
        self._thread = threading.Thread(target=self._run, name="look", daemon=True)
        self._thread.start()

    def edit(self, values: Mapping[str, Any]) -> None:
        """Give attributes other values, soon."""
        self._ask(lambda: self._values.update(values))

    def move(self, prim: str, move: Move) -> None:
        """Move a light, or the camera for "", soon."""

        def add() -> None:
            self._moves[prim] = self._moves[prim].then(move) if prim in self._moves else move

        self._ask(add)

    def place(self, prim: str, matrix: np.ndarray) -> None:
        """Put a light, or the camera for "", where ``LiveStage.place`` says, soon."""

        def put() -> None:
            self._places[prim] = matrix
            self._moves.pop(prim, None)

        self._ask(put)

    def wait(self, version: int, timeout: float | None = None) -> Shown:
        """What is shown once its version is above ``version``, or what there is when ``timeout`` seconds are over.

        Raises what ended the thread, if something did.
        """
        with self._condition:
            self._condition.wait_for(lambda: self.shown.version > version or self._failure or self._closed, timeout)
            if self._failure:
                raise self._failure
            return self.shown

    def finished(self, timeout: float | None = None) -> Shown:
        """What is shown once every edit is in and the image is finished; what there is when time is over."""

        def done() -> bool:
            return bool(self._failure) or (not self._asked() and self.shown.finished)

        with self._condition:
            self._condition.wait_for(done, timeout)
            if self._failure:
                raise self._failure
            return self.shown

    def do(self, work: Callable[[LiveStage, Session], Any]) -> Any:
        """The result of ``work``, done in the thread after all edits so far; raises what it raises."""
        answer: Future[Any] = Future()

        def call() -> Any:
            assert self._session is not None
            return work(self._live, self._session)

        self._ask(lambda: self._calls.append((answer, call)))
        return answer.result()

    def reset(self) -> None:
        """Drop every edit."""

        def drop(live: LiveStage, session: Session) -> None:
            live.reset()
            self._changed(session)

        self.do(drop)

    def close(self) -> None:
        """End the thread."""
        with self._condition:
            self._closed = True
            self._condition.notify_all()
        self._thread.join()
        for answer, _ in self._calls:
            answer.cancel()

    def __enter__(self) -> "Looking":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _ask(self, note: Callable[[], object]) -> None:
        with self._condition:
            if self._failure:
                raise self._failure
            note()
            self._condition.notify_all()

    def _asked(self) -> bool:
        return bool(self._values or self._moves or self._places or self._calls or self._closed)

    def _run(self) -> None:
        try:
            self._session = session = Session(self._live.scene, self._settings)
            self._show(message="", redone=str(session.redone), **self._sizes(session))
            while self._step(session):
                pass
        except BaseException as error:  # told to whoever waits
            with self._condition:
                self._failure = error
                self._condition.notify_all()
            for answer, _ in self._calls:
                answer.set_exception(error)

    def _step(self, session: Session) -> bool:
        """Take what was asked for, then make the image a step better; False when closed."""
        with self._condition:
            self._condition.wait_for(lambda: self._asked() or not session.finished)
            if self._closed:
                return False
            values, moves, places, calls = self._values, self._moves, self._places, self._calls
            self._values, self._moves, self._places, self._calls = {}, {}, {}, []
            # the step that follows belongs to these: whoever asks for the finished image waits for it
            self.shown = replace(self.shown, samples=0) if values or moves or places else self.shown
        if values or moves or places:
            self._apply(session, values, moves, places)
        for answer, call in calls:
            try:
                answer.set_result(call())
            except Exception as error:  # of whoever asked
                answer.set_exception(error)
        film = session.refine(self._asked)
        if film is not None:
            self._publish(session, film)
        return True

    def _apply(
        self, session: Session, values: Mapping[str, Any], moves: Mapping[str, Move], places: Mapping[str, np.ndarray]
    ) -> None:
        try:
            with self._live.attempt():
                for prim, matrix in places.items():
                    self._live.place(prim, matrix)
                for prim, move in moves.items():
                    self._live.place(prim, moved(self._live, prim, move))
                if values:
                    self._live.edit(values)
                self._changed(session)
        except (ValueError, OSError) as error:
            self._show(message=str(error), edits=self.shown.edits + 1, samples=session.samples)

    def _changed(self, session: Session) -> None:
        redone = session.change(self._live.scene, read=self._live.seconds)
        self._show(
            redone=str(redone), message="", edits=self.shown.edits + 1, controls=self._live.controls(),
            **self._sizes(session),
        )  # fmt: skip

    def _publish(self, session: Session, film: Film) -> None:
        pixels = eight_bit(film["color"])
        self._show(pixels=pixels, picture=self.shown.version + 1, **self._sizes(session))

    @staticmethod
    def _sizes(session: Session) -> dict[str, Any]:
        assert session.plan is not None
        spp = session.plan.settings.spp or 1
        return {"size": session.plan.size, "samples": session.samples, "spp": spp, "scene": session.scene}

    def _show(self, **fields: Any) -> None:
        with self._condition:
            self.shown = replace(self.shown, version=self.shown.version + 1, **fields)
            self._condition.notify_all()


def _size(scene: Scene, settings: Settings) -> tuple[int, int]:
    """(width, height) of the image; (1, 1) where that is at fault, of which the plan will tell."""
    try:
        return resolve(scene, settings)[1]
    except ValueError:
        return 1, 1
