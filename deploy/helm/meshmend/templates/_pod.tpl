{{- /* The pod of a server: of `root`, the chart's own context, and a `role`. */ -}}
{{- define "meshmend.pod" -}}
{{- $root := .root -}}
{{- $shared := $root.Values.shared -}}
{{- /* Servers that only run jobs need neither the keys of callers nor what webhooks are signed with. */ -}}
{{- $hasKeys := and $root.Values.apiKeys.secretName (ne .role "worker") -}}
{{- $hasWebhooks := and $root.Values.webhooks.enabled (ne .role "worker") -}}
{{- $secrets := list -}}
{{- if $hasKeys }}{{ $secrets = append $secrets (list "keys" $root.Values.apiKeys.secretName $root.Values.apiKeys.key) }}{{ end -}}
{{- if and $hasWebhooks $root.Values.webhooks.secretName }}{{ $secrets = append $secrets (list "webhooks" $root.Values.webhooks.secretName $root.Values.webhooks.key) }}{{ end -}}
{{- if $shared.enabled }}
{{- with $shared.databasePassword.secretName }}{{ $secrets = append $secrets (list "database" . $shared.databasePassword.key) }}{{ end -}}
{{- with $shared.blobsKey.secretName }}{{ $secrets = append $secrets (list "blobs" . $shared.blobsKey.key) }}{{ end -}}
{{- if $hasWebhooks }}{{ $secrets = append $secrets (list "store" $shared.storeKey.secretName $shared.storeKey.key) }}{{ end -}}
{{- end -}}
metadata:
  labels:
    {{- include "meshmend.labels" $root | nindent 4 }}
    {{- include "meshmend.component" .role | nindent 4 }}
    {{- with $root.Values.podLabels }}{{ toYaml . | nindent 4 }}{{ end }}
  {{- with $root.Values.podAnnotations }}
  annotations: {{- toYaml . | nindent 4 }}
  {{- end }}
spec:
  automountServiceAccountToken: false
  # Otherwise a service called "meshmend" puts MESHMEND_SERVICE_* and MESHMEND_PORT* among the settings.
  enableServiceLinks: false
  terminationGracePeriodSeconds: {{ $root.Values.terminationGracePeriodSeconds }}
  {{- with $root.Values.priorityClassName }}
  priorityClassName: {{ . }}
  {{- end }}
  {{- with $root.Values.imagePullSecrets }}
  imagePullSecrets: {{- toYaml . | nindent 4 }}
  {{- end }}
  securityContext:
    runAsNonRoot: true
    runAsUser: 65532
    runAsGroup: 65532
    fsGroup: 65532
    fsGroupChangePolicy: OnRootMismatch
    seccompProfile:
      type: RuntimeDefault
  containers:
    - name: meshmend
      image: {{ include "meshmend.image" $root | quote }}
      imagePullPolicy: {{ $root.Values.image.pullPolicy }}
      args: [serve]
      env:
        - name: MESHMEND_ROLE
          value: {{ .role }}
        - name: MESHMEND_LISTEN
          value: 0.0.0.0:8080
        - name: MESHMEND_ADMIN_LISTEN
          value: 0.0.0.0:8081
        - name: MESHMEND_DATA_DIR
          value: /data/meshmend
        {{- if $hasKeys }}
        - name: MESHMEND_API_KEYS_FILE
          value: /run/secrets/meshmend-keys/value
        {{- end }}
        {{- if $root.Values.allowAnonymous }}
        - name: MESHMEND_ALLOW_ANONYMOUS
          value: "true"
        {{- end }}
        {{- if $hasWebhooks }}
        - name: MESHMEND_WEBHOOKS
          value: "true"
        {{- if $root.Values.webhooks.secretName }}
        - name: MESHMEND_WEBHOOK_SECRET_FILE
          value: /run/secrets/meshmend-webhooks/value
        {{- end }}
        {{- end }}
        {{- if $shared.enabled }}
        - name: MESHMEND_DATABASE_URL
          value: {{ $shared.databaseUrl | quote }}
        - name: MESHMEND_BLOBS_URL
          value: {{ $shared.blobsUrl | quote }}
        {{- with $shared.blobsEndpoint }}
        - name: MESHMEND_BLOBS_ENDPOINT
          value: {{ . | quote }}
        {{- end }}
        {{- if $shared.databasePassword.secretName }}
        - name: MESHMEND_DATABASE_PASSWORD_FILE
          value: /run/secrets/meshmend-database/value
        {{- end }}
        {{- if $shared.blobsKey.secretName }}
        - name: MESHMEND_BLOBS_KEY_FILE
          value: /run/secrets/meshmend-blobs/value
        {{- end }}
        {{- if $hasWebhooks }}
        - name: MESHMEND_STORE_KEY_FILE
          value: /run/secrets/meshmend-store/value
        {{- end }}
        {{- end }}
        {{- range $name, $value := $root.Values.settings }}
        - name: MESHMEND_{{ upper $name }}
          value: {{ if kindIs "float64" $value }}{{ int64 $value | quote }}{{ else }}{{ $value | quote }}{{ end }}
        {{- end }}
      ports:
        - name: http
          containerPort: 8080
        - name: admin
          containerPort: 8081
      # A store may be migrated before anything answers.
      startupProbe:
        httpGet:
          path: /livez
          port: admin
        periodSeconds: 2
        failureThreshold: 150
      livenessProbe:
        httpGet:
          path: /livez
          port: admin
        periodSeconds: 10
        timeoutSeconds: 5
        failureThreshold: 6
      readinessProbe:
        httpGet:
          path: /readyz
          port: admin
        periodSeconds: 5
        timeoutSeconds: 3
      resources: {{- toYaml (ternary $shared.api.resources $root.Values.resources (eq .role "api")) | nindent 8 }}
      securityContext:
        allowPrivilegeEscalation: false
        readOnlyRootFilesystem: true
        capabilities:
          drop: [ALL]
      volumeMounts:
        - name: data
          mountPath: /data
        - name: tmp
          mountPath: /tmp
        {{- range $secrets }}
        - name: {{ first . }}
          mountPath: /run/secrets/meshmend-{{ first . }}
          readOnly: true
        {{- end }}
  {{- with $root.Values.nodeSelector }}
  nodeSelector: {{- toYaml . | nindent 4 }}
  {{- end }}
  {{- with $root.Values.tolerations }}
  tolerations: {{- toYaml . | nindent 4 }}
  {{- end }}
  {{- with $root.Values.affinity }}
  affinity: {{- toYaml . | nindent 4 }}
  {{- end }}
  volumes:
    - name: tmp
      emptyDir:
        sizeLimit: 1Gi
    {{- if $shared.enabled }}
    # Its name, and copies of files in use.
    - name: data
      emptyDir:
        sizeLimit: {{ $shared.copiesSize }}
    {{- end }}
    {{- range $secrets }}
    - name: {{ first . }}
      secret:
        secretName: {{ index . 1 }}
        defaultMode: 0440
        items:
          - key: {{ index . 2 }}
            path: value
    {{- end }}
{{- end }}
