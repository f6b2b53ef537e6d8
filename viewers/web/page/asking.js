// Wishes are sent one at a time; what comes while one is under way is merged and sent after it.

export async function ask(trame, name, body) {
  const answer = await trame.trigger(name, [body]);
  if (!answer) throw new Error("the viewer does not answer");
  if (answer.error) throw new Error(answer.error);
  return answer;
}

export function sender(send, merge, failed) {
  let waiting = null, busy = false;
  const flush = async () => {
    busy = true;
    while (waiting !== null) {
      const body = waiting;
      waiting = null;
      try { await send(body); } catch (error) { failed(error); }
    }
    busy = false;
  };
  return (body) => {
    waiting = waiting === null ? body : merge(waiting, body);
    if (!busy) flush();
  };
}

const STILL = { right: 0, up: 0, across: 0, along: 0, nearer: 1 };

export const moving = (body) => ({ ...STILL, ...body });

export const then = (a, b) => ({
  prim: a.prim, right: a.right + b.right, up: a.up + b.up, across: a.across + b.across, along: a.along + b.along, nearer: a.nearer * b.nearer,
});
