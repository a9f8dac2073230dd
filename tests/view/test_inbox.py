"""Messages that wait to be carried out: order, newer values, a limit."""

import asyncio

from fftocean.view.inbox import MOST_WAITING, Inbox
from fftocean.view.protocol import Copy, Refusal, SetValues


def taken(*messages):
    """Return what is taken from an inbox after some messages were put into it."""

    async def run():
        inbox = Inbox()
        for message in messages:
            await inbox.put(message)
        inbox.close()
        found = []
        while (message := await inbox.get()) is not None:
            found.append(message)
        return found

    return asyncio.run(run())


def test_newer_values_replace_waiting_ones_of_the_same_parameters():
    values = [SetValues({"wind_speed": float(i)}) for i in range(5000)]
    assert taken(*values) == values[-1:]
    both = SetValues({"wind_speed": 3.0, "seed": 1})
    assert taken(values[0], both) == [both]


def test_no_value_is_lost_and_the_order_is_kept():
    wind, depth = SetValues({"wind_speed": 5.0, "seed": 2}), SetValues({"seed": 3})
    bad, copy = Refusal("a message must be text"), Copy("job")
    messages = [wind, depth, copy, wind, bad, wind]
    assert taken(*messages) == messages


def test_a_full_inbox_makes_the_sender_wait():
    async def run():
        inbox = Inbox()
        putting = asyncio.create_task(put_all(inbox))
        for _ in range(10):
            await asyncio.sleep(0)
        assert len(inbox) == MOST_WAITING
        found = [await inbox.get() for _ in range(MOST_WAITING + 1)]
        await putting
        assert found == [Copy("job")] * (MOST_WAITING + 1)

    async def put_all(inbox):
        for _ in range(MOST_WAITING + 1):
            await inbox.put(Copy("job"))

    asyncio.run(run())
