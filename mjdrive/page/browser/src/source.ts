// Where towns and recorded drives come from: from the server, or from the file that the page itself is.
import { fetchMessage, unpack, type Message } from "./codec";

export interface Source {
  /** The town of that name; the one that is driven if none is given. */
  scene(town?: string): Promise<Message>;
  episode(name: string): Promise<Message>;
  /** What the policy saw at a step of an episode. */
  view(name: string, step: number): Promise<Message>;
}

const about = (values: Record<string, string>): string => new URLSearchParams(values).toString();

export const SERVER: Source = {
  scene: (town) => fetchMessage(town ? `api/scene?${about({ town })}` : "api/scene"),
  episode: (name) => fetchMessage(`api/episode?${about({ name })}`),
  view: (name, step) => fetchMessage(`api/episode/view?${about({ name, step: String(step) })}`),
};

/** One drive, as `mjdrive export --to html` writes it: messages of the server in base64 (mjdrive/exchange/html/page.py). */
export interface Recording { title: string; scene: string; episode: string; views: string[] }

export function inside(recording: Recording): Source {
  const message = (text: string): Promise<Message> => unpack(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
  return {
    scene: () => message(recording.scene),
    episode: () => message(recording.episode),
    view: (_, step) => message(recording.views[step]),
  };
}
