// Client of the Meshmend service: repairs 3D meshes for printing and proves it. For Node 20 and newer, and browsers.

export { type CallOptions, type ClientOptions, Meshmend } from "./client.js";
export {
  ConnectionFailedError,
  IntegrityError,
  MeshmendError,
  NotFinishedError,
  NotRepairableError,
  ProblemError,
  UnexpectedAnswerError,
  WebhookError,
} from "./errors.js";
export type { JobEvent } from "./events.js";
export { Result } from "./result.js";
export type { Retries } from "./retries.js";
export type * from "./types.js";
export { type KeptMesh, type Mesh, UploadOf } from "./upload.js";
export { verifyWebhook, type WebhookCheck } from "./webhooks.js";
